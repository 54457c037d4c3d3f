"""The README is the first page of the site, notebooks are pages, and links that leave `docs` lead to the repository."""

from __future__ import annotations

import posixpath
import re
from pathlib import Path
from typing import Any

import executed
from mkdocs.structure.files import File

ROOT = Path(__file__).parent.parent
TREE = "https://github.com/palpate/palpate/blob/main/"
NOTEBOOKS = "examples/notebooks/"
IMAGES = "https://raw.githubusercontent.com/palpate/palpate/main/"
LINK = re.compile(r"(\]\()([^)\s]+)(\))")


def on_files(files: Any, config: Any) -> Any:
    files.append(File.generated(config, "index.md", content=(ROOT / "README.md").read_text(encoding="utf-8")))
    for path, content in executed.pages(ROOT / NOTEBOOKS).items():
        files.append(File.generated(config, path, content=content))
    return files


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    if page.file.src_uri.startswith(executed.FOLDER):
        # Its outputs are not Markdown.
        return markdown
    folder = posixpath.dirname(page.file.src_uri)

    def target(link: str) -> str:
        for address in (TREE, IMAGES):
            if link.startswith(f"{address}docs/"):
                return posixpath.relpath(link.removeprefix(f"{address}docs/"), folder or ".")
        if link.startswith(TREE + NOTEBOOKS):
            return posixpath.relpath(f"{executed.FOLDER}/{Path(link).stem}.md", folder or ".")
        if "://" in link or link.startswith("#"):
            return link
        path = posixpath.normpath(posixpath.join("docs", folder, link))
        return link if path.startswith("docs/") else TREE + path

    return LINK.sub(lambda match: match[1] + target(match[2]) + match[3], markdown)
