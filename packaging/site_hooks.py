"""What mkdocs calls while it builds the site."""

from markdown.extensions import Extension
from mkdocs.structure.nav import Link


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
