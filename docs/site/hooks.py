"""What mkdocs.yml cannot say: its own folder is no part of the site, the reference is."""

from mkdocs.structure.nav import Link


def on_files(files, config):
    for file in list(files):
        if file.src_path.startswith("site/") and not file.src_path.endswith(".css"):
            files.remove(file)
    return files


def on_nav(nav, config, files):
    nav.items.append(Link("Reference", "reference/index.html"))
    return nav
