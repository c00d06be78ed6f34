"""Links and pictures of the pages in a folder: each that stays inside must lead to a file, and to a place in it. The pages
below rust/ are checked by rustdoc."""

import sys
import urllib.parse
from html.parser import HTMLParser
from pathlib import Path


class Page(HTMLParser):
    """What a page links to, and the places in it that can be linked to."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.places = {"", "top"}
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.places.add(value)
            elif name in ("href", "src") and value is not None and tag != "base":
                self.links.append(value)


folder = Path(sys.argv[1]).resolve()
pages = {path: Page(path) for path in sorted(folder.rglob("*.html")) if folder / "rust" not in path.parents}
broken = []
for path, page in pages.items():
    # Of the page that stands for all that are missing, links begin at the site's root.
    for link in page.links if path.name != "404.html" else ():
        parts = urllib.parse.urlsplit(link)
        if parts.scheme or parts.netloc:
            if path.name != "print.html" and "cdn" in parts.netloc:
                broken.append(f"{path.name}: {link} needs a network")
            continue
        target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
        target = target / "index.html" if target.is_dir() else target
        place = urllib.parse.unquote(parts.fragment)
        if not target.exists():
            broken.append(f"{path.name}: there is no {link}")
        elif target in pages and path.name != "print.html" and place not in pages[target].places:
            broken.append(f"{path.name}: there is no place {link}")
print("\n".join(sorted(set(broken))) or f"{len(pages)} pages, {sum(len(page.links) for page in pages.values())} links")
sys.exit(bool(broken))
