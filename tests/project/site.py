#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The site: makes it by cmake/site.sh, and checks it.

usage: site.py ROOT WORK

All links of all pages lead to a file that is there, and to a place in it; nothing is asked of a network. Each page of README.md and
docs/ is there with all its headings and words, and can be searched for, as can names of the library. At last a link is broken, a word is taken
out and a name is taken from the index, and that has to be noticed.
"""

import html.parser
import re
import shutil
import subprocess
import sys
import urllib.parse
from pathlib import Path

VOID = {"meta", "link", "img", "br", "hr", "input", "area", "col", "wbr"}


class Page(html.parser.HTMLParser):
    """What a page of the site links to, its places, and its words."""

    def __init__(self, path):
        super().__init__()
        self.links, self.places, self.loads, self.words, self.quiet = [], set(), [], [], 0
        self.feed(path.read_text(encoding="utf-8"))
        self.text = " ".join(" ".join(self.words).split())

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        for name in ("id", "name"):
            if attributes.get(name):
                self.places.add(attributes[name])
        if tag in ("script", "style"):
            self.quiet += 1
        if tag == "img":
            self.words.append(f" {attributes.get('alt') or ''} ")
        if tag == "a" and attributes.get("href"):
            self.links.append(attributes["href"])
        loaded = attributes.get("src") or (attributes.get("href") if tag == "link" else None)
        if loaded:
            self.loads.append(loaded)

    def handle_endtag(self, tag):
        if tag in ("script", "style"):
            self.quiet -= 1

    def handle_data(self, data):
        if not self.quiet:
            self.words.append(data)


def read(site):
    return {path.name: Page(path) for path in sorted(site.glob("*.html"))}


def broken_links(site, pages):
    for name, page in pages.items():
        for link in page.links + page.loads:
            if link.startswith("javascript:"):
                continue  # of Doxygen's field to search in
            if re.match(r"[a-z]+:|//", link):
                if link in page.loads or not re.match(r"https?://|mailto:", link):
                    yield f"{name}: {link} is not of this site"
                continue
            path, _, place = urllib.parse.unquote(link).partition("#")
            to = path or name
            if not (site / to).is_file():
                yield f"{name}: there is no {to}"
            elif place and to in pages and place not in pages[to].places and place != "nested-classes":  # Doxygen forgets this one
                yield f"{name}: {to} has no #{place}"


def headings_of(text):
    text = re.sub(r"^ *```.*?^ *```", "", text, flags=re.MULTILINE | re.DOTALL)
    for heading in re.findall(r"^#+ (.*?)\s*$", text, re.MULTILINE):
        yield " ".join(re.sub(r"\[(.*?)\]\(.*?\)", r"\1", heading).replace("`", "").split())


def plain(text):
    """Letters and digits alone: the site's and the page's marks differ."""
    return re.sub(r"[^A-Za-z0-9]+", "", text)


def lines_of(text):
    """Sentences and cells of a page, without what is no text for a reader."""
    text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    text = re.sub(r"!?\[((?:[^\[\]]|\[[^\[\]]*\])*?)\]\([^()\s]+\)", r"\1", text)
    text = re.sub(r"<a [^>]*>|</a>|<br>|^ *```.*$", "", text, flags=re.MULTILINE)
    return [line for line in (plain(re.sub(r"^ *\d+\. ", "", line)) for line in re.split(r"\n|\|", text)) if len(line) > 8]


def missing(root, pages, index):
    """Pages, headings, lines and names that the site lacks."""
    sources = [root / "README.md"] + sorted(path for path in (root / "docs").rglob("*.md") if path.name != "index.md")
    for source in sources:
        label = "page_" + re.sub(r"\W", "_", str(source.relative_to(root).with_suffix("")))
        page = pages.get("index.html" if source.name == "README.md" and source.parent == root else f"{label}.html")
        where = source.relative_to(root)
        if page is None:
            yield f"{where}: there is no page"
            continue
        text, shown = source.read_text(encoding="utf-8"), plain(page.text)
        for heading in headings_of(text):
            if plain(heading) not in shown:
                yield f"{where}: no heading '{heading}'"
        for line in lines_of(text):
            if line not in shown:
                yield f"{where}: the words are not there: {line[:60]}"
        title = next(headings_of(text))
        if html.escape(title, quote=True).replace("&#x27;", "&apos;") not in index:
            yield f"{where}: '{title}' cannot be searched for"
    for name in ("make_bvh", "contact_patches", "gltf_scene", "intersects"):
        if name not in index:
            yield f"{name} cannot be searched for"


def index_of(site):
    return "\n".join(path.read_text(encoding="utf-8") for path in sorted((site / "search").glob("*.js")))


def main():
    if shutil.which("doxygen") is None:
        print("abut skips: doxygen is not there")
        return 0
    root, work = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    subprocess.run(["sh", root / "cmake/site.sh", work], check=True, stdout=subprocess.DEVNULL)
    site = work / "html"
    pages, index = read(site), index_of(site)
    problems = list(broken_links(site, pages)) + list(missing(root, pages, index))
    for line in problems[:40]:
        print(line)
    links = sum(len(page.links) for page in pages.values())
    manual = pages["index.html"]
    unnoticed = 0
    for where, plant in ((manual.links, "page_docs_none.html"), (manual.links, "page_docs_viewer.html#none"), (manual.links, "files/none.txt"),
                         (manual.links, "file:none"), (manual.loads, "https://example.org/a.js")):
        where.append(plant)
        unnoticed += not list(broken_links(site, {"index.html": manual, "page_docs_viewer.html": pages["page_docs_viewer.html"]}))
        where.pop()
    kept, manual.text = manual.text, manual.text.replace("exactly", "", 1)
    unnoticed += len(list(missing(root, pages, index))) <= len(problems)
    manual.text = kept
    unnoticed += len(list(missing(root, pages, index.replace("make_bvh", "")))) <= len(problems)
    print(f"{len(pages)} pages, {links} links: {len(problems)} problems, {unnoticed} plants unnoticed")
    return 1 if problems or unnoticed or links < 1000 else 0


if __name__ == "__main__":
    sys.exit(main())
