"""What mkdocs calls while it builds the site."""

import json
import pathlib

from markdown.extensions import Extension
from mkdocs.structure.nav import Link
from mkdocs.utils import get_relative_url


class WithoutHtml(Extension):
    """The documents contain no HTML, but formulas that could be taken for it, such as <p, q>."""

    def extendMarkdown(self, md):
        md.preprocessors.deregister("html_block")
        md.inlinePatterns.deregister("html")


def on_config(config):
    config["markdown_extensions"].append(WithoutHtml())
    return config


def on_nav(nav, config, files):
    """The reference consists of finished pages, which mkdocs takes into no list of its own."""
    nav.items.append(Link("Reference", "reference/index.html"))
    return nav


# The theme's search asks for its index and starts a program in a thread of its own, neither of which a
# browser permits to pages that it reads from a folder. It takes both from the object __search if there
# is one (Material for MkDocs 8).
SEARCH = "search/search.js"


def on_post_page(output, page, config):
    script = f'<script src="{get_relative_url(SEARCH, page.url)}"></script>'
    return output.replace('<script id="__config"', script + '<script id="__config"')


def on_post_build(config):
    site = pathlib.Path(config["site_dir"])
    index = json.loads((site / "search/search_index.json").read_text(encoding="utf-8"))
    (worker,) = site.glob("assets/javascripts/workers/search.*.js")
    program = json.dumps(worker.read_text(encoding="utf-8"))
    (site / SEARCH).write_text(
        f"var __search = {{\n  index: Promise.resolve({json.dumps(index)}),\n"
        f"  worker: URL.createObjectURL(new Blob([{program}])),\n}};\n",
        encoding="utf-8",
    )
