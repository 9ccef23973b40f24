"""What mkdocs.yml cannot say: its own folder is no part of the site, the reference is, and so are
the examples that pages link to outside docs/, of which the notebook is a page."""

import json
import os
import re

from mkdocs.structure.files import File
from mkdocs.structure.nav import Link

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
NOTEBOOK = "examples/notebook/study.ipynb"
NOTEBOOK_PAGE = "notebook.md"
OUTSIDE = re.compile(r"\[([^]]*)\]\(\.\./([\w./-]+)\)")


def on_config(config):
    with open(os.path.join(TOP, "CMakeLists.txt"), encoding="utf-8") as lists:
        version = re.search(r"project\(fathom VERSION ([\d.]+)", lists.read()).group(1)
    config["copyright"] = f"Fathom {version}, BSD-3-Clause"
    return config


def on_files(files, config):
    for file in list(files):
        if file.src_path.startswith("site/") and not file.src_path.endswith((".css", ".js")):
            files.remove(file)
    for file in list(files.documentation_pages()):
        if os.path.dirname(file.src_path):
            continue
        with open(file.abs_src_path, encoding="utf-8") as page:
            linked = {path for _, path in OUTSIDE.findall(page.read())}
        for path in sorted(linked - {NOTEBOOK}):
            if os.path.isfile(os.path.join(TOP, path)) and not files.get_file_from_path(path):
                files.append(File(path, TOP, config["site_dir"], use_directory_urls=False))
    files.append(File(NOTEBOOK_PAGE, TOP, config["site_dir"], use_directory_urls=False))
    return files


def on_page_read_source(page, config):
    if page.file.src_path != NOTEBOOK_PAGE:
        return None
    with open(os.path.join(TOP, NOTEBOOK), encoding="utf-8") as file:
        return "\n\n".join(map(cell_as_markdown, json.load(file)["cells"]))


def cell_as_markdown(cell):
    """The text of a cell, of code with the texts that are stored as its outputs."""
    text = "".join(cell["source"])
    if cell["cell_type"] == "markdown":
        return text
    outputs = "".join(
        "".join(one["text"] if "text" in one else one["data"]["text/plain"]).rstrip("\n") + "\n"
        for one in cell["outputs"]
    )
    return f"```python\n{text}\n```" + (f"\n\n```text\n{outputs}```" if outputs else "")


def on_page_markdown(markdown, page, config, files):
    """A file outside docs/ lies in the site at its path; of a folder only its name stays."""
    if os.path.dirname(page.file.src_path):
        return markdown

    def inside(link):
        text, path = link.groups()
        if path == NOTEBOOK:
            return f"[{text}]({NOTEBOOK_PAGE})"
        return f"[{text}]({path})" if files.get_file_from_path(path) else f"`{text}`"

    return OUTSIDE.sub(inside, markdown)


def on_nav(nav, config, files):
    nav.items.append(Link("Reference", "reference/index.html"))
    return nav


def on_post_build(config):
    """The index of the search as a script, for pages that are opened as files."""
    folder = os.path.join(config["site_dir"], "search")
    with open(os.path.join(folder, "search_index.json"), encoding="utf-8") as index:
        text = index.read()
    with open(os.path.join(folder, "search_index.js"), "w", encoding="utf-8") as script:
        script.write(f"const __search = {{index: Promise.resolve({text})}};\n")
