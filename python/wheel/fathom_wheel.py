"""Builds the wheel of the Python package (PEP 517): CMake compiles, this packs.

FATHOM_BUILD_DIR, where it is set, is a build folder whose module is packed as it is; else one is
made in build/wheel.
"""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile

TOP = pathlib.Path(__file__).resolve().parents[2]


class UnsupportedOperation(Exception):
    """What PEP 517 calls a hook that there is not."""


def build_sdist(sdist_directory, config_settings=None):
    raise UnsupportedOperation("there is no source distribution: the repository is the source")


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Without it pip compiles to learn a name."""
    folder = pathlib.Path(metadata_directory, f"fathom-{_version()}.dist-info")
    folder.mkdir()
    for name, content in _about().items():
        (folder / name).write_bytes(content)
    return folder.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    of_wheel = f"fathom-{_version()}.dist-info"
    name = f"fathom-{_version()}-{_tag()}.whl"
    with tempfile.TemporaryDirectory() as folder:
        package = _installed(pathlib.Path(os.environ.get("FATHOM_BUILD_DIR") or _built()), folder)
        files = {f"fathom/{one.name}": one.read_bytes() for one in sorted(package.iterdir())}
    files |= {f"{of_wheel}/{one}": content for one, content in _about().items()}
    files[f"{of_wheel}/RECORD"] = _record(files, f"{of_wheel}/RECORD").encode()
    with zipfile.ZipFile(pathlib.Path(wheel_directory, name), "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, content in files.items():
            # A time of its own: the same sources give the same bytes.
            wheel.writestr(zipfile.ZipInfo(path), content, zipfile.ZIP_DEFLATED)
    return name


def _version():
    lists = (TOP / "CMakeLists.txt").read_text()
    return re.search(r"project\(fathom VERSION ([\d.]+)", lists).group(1)


def _tag():
    interpreter = f"cp{sys.version_info.major}{sys.version_info.minor}"
    system = re.sub(r"[-.]", "_", sysconfig.get_platform())
    return f"{interpreter}-{interpreter}-{system}"


def _about():
    """What a wheel says of itself, by the name of the file."""
    wheel = "Wheel-Version: 1.0\nGenerator: fathom_wheel\nRoot-Is-Purelib: false\n"
    return {
        "METADATA": _metadata().encode(),
        "LICENSE": (TOP / "LICENSE").read_bytes(),
        "WHEEL": f"{wheel}Tag: {_tag()}\n".encode(),
    }


def _run(*command):
    words = [str(word) for word in command]
    # There pip puts what hides the system's numpy from an isolated build.
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    if subprocess.run(words, cwd=TOP, env=environment).returncode != 0:
        sys.exit(f"fathom: error: '{' '.join(words)}' failed; what it said is above")


def _built():
    folder = TOP / "build" / "wheel"
    choices = {
        "FATHOM_PYTHON": "ON",
        "FATHOM_TESTS": "OFF",
        "FATHOM_BENCHMARKS": "OFF",
        # Of a virtual environment the interpreter that it is of, which has the headers.
        "Python3_EXECUTABLE": os.path.realpath(sys.executable),
    }
    options = [f"-D{key}={value}" for key, value in choices.items()]
    _run("cmake", "--preset", "release", "-B", folder, *options)
    _run("cmake", "--build", folder, "--target", "fathom_python", "fathom_python_plugins")
    return folder


def _installed(build, folder):
    """The package as CMake installs it, which sets where its libraries are looked for."""
    module = f"_fathom{sysconfig.get_config_var('EXT_SUFFIX')}"
    if not (build / "python" / "fathom" / module).is_file():
        sys.exit(f"fathom: error: FATHOM_BUILD_DIR: expected {module} in {build}/python/fathom")
    _run("cmake", "--install", build, "--component", "python", "--prefix", folder, "--strip")
    return next(pathlib.Path(folder).glob("lib*/python*/*-packages/fathom"))


def _metadata():
    about = tomllib.loads((TOP / "pyproject.toml").read_text())["project"]
    lines = [
        "Metadata-Version: 2.1",
        f"Name: {about['name']}",
        f"Version: {_version()}",
        f"Summary: {about['description']}",
        f"License: {about['license']['text']}",
        f"Requires-Python: {about['requires-python']}",
        *(f"Requires-Dist: {one}" for one in about["dependencies"]),
    ]
    for extra, needed in about["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f'Requires-Dist: {one}; extra == "{extra}"' for one in needed]
    return "\n".join(lines) + "\n"


def _record(files, own):
    lines = []
    for path, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
        lines.append(f"{path},sha256={digest},{len(content)}")
    return "\n".join([*lines, f"{own},,"]) + "\n"
