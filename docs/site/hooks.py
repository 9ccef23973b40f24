"""What mkdocs.yml cannot say: its own folder is no part of the site, the reference is, and so are
the examples that pages link to outside docs/, of which the notebook is a page. KaTeX draws the
formulas where it is installed (libjs-katex of Debian, or the folder that $FATHOM_KATEX names); else
their source is shown."""

import json
import os
import re

from mkdocs.structure.files import File
from mkdocs.structure.nav import Link

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
NOTEBOOK = "examples/notebook/study.ipynb"
NOTEBOOK_PAGE = "notebook.md"
OUTSIDE = re.compile(r"\[([^]]*)\]\(\.\./([\w./-]+)\)")

KATEX = os.environ.get("FATHOM_KATEX", "/usr/share/javascript/katex")
LONG_CELL = 60  # characters


def katex_files():
    """What the site needs of KaTeX, relative to its folder; nothing where it is missing."""
    needed = ["katex.min.css", "katex.min.js"]
    if not all(os.path.isfile(os.path.join(KATEX, name)) for name in needed):
        return []
    fonts = os.listdir(os.path.join(KATEX, "fonts"))
    return needed + [f"fonts/{name}" for name in sorted(fonts) if name.endswith(".woff2")]


def on_config(config):
    with open(os.path.join(TOP, "CMakeLists.txt"), encoding="utf-8") as lists:
        version = re.search(r"project\(fathom VERSION ([\d.]+)", lists.read()).group(1)
    config["copyright"] = f"Fathom {version}, BSD-3-Clause"
    if katex_files():
        config["extra_css"] += ["katex/katex.min.css"]
        config["extra_javascript"] += ["katex/katex.min.js", "site/formulas.js"]
    return config


def on_files(files, config):
    for file in list(files):
        if file.src_path.startswith("site/") and not file.src_path.endswith((".css", ".js")):
            files.remove(file)
    for name in katex_files():
        files.append(File(f"katex/{name}", os.path.dirname(KATEX), config["site_dir"],
                          use_directory_urls=False))
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


def on_page_content(html, page, config, files):
    """Cells of many words are marked, so that a narrow screen leaves them a width to be read at."""
    def marked(cell):
        words = re.sub(r"<[^>]*>", "", cell[1])
        return cell[0] if len(words) < LONG_CELL else f'<td class="long">{cell[1]}</td>'

    return re.sub(r"<td>(.*?)</td>", marked, html, flags=re.DOTALL)


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
