#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The site: makes it by cmake/site.sh, and checks it.

usage: site.py ROOT WORK

All links of all pages lead to a file that is there, and to a place in it; nothing is asked of a network. Each page of README.md and
docs/ is there with all its headings and words, and can be searched for, as can names of the library. Words in the text of each section find
it, where node can run the search. At last a link is broken, a word is taken out, a name is taken from the index and a section from the search,
and that has to be noticed.
"""

import html.parser
import json
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


FIND = """
const fs = require("fs"), vm = require("vm"), site = process.argv[1] + "/";
const world = vm.createContext({});
for (const name of ["lunr.js", "search_sections.js", "search_text.js"]) vm.runInContext(fs.readFileSync(site + name, "utf8"), world);
if (process.argv[2]) vm.runInContext(`search_sections.splice(${process.argv[2]}, 1)`, world);
const asked = JSON.parse(fs.readFileSync(0, "utf8"));
console.log(JSON.stringify(asked.map(words => world.find_sections(words).map(section => section[0]))));
"""


def found(site, asked, *left_out):
    """Which sections the site's own search finds for each of what is asked."""
    done = subprocess.run(["node", "-e", FIND, str(site), *left_out], input=json.dumps(asked), capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def unfound(site, pages):
    """Sections that their own words do not find, how many were looked for, and the plants that were not noticed."""
    sections = json.loads((site / "search_sections.js").read_text(encoding="utf-8")[len("var search_sections = "):].rstrip(";\n"))
    asked, wanted, problems = [], [], []
    for address, title, text in sections:
        name, _, place = address.partition("#")
        if name not in pages or place and place not in pages[name].places:
            problems.append(f"search: {title}: there is no {address}")
        words = [word for word in text.split() if len(word) > 3][-40:]
        shown = plain(pages[name].text) if name in pages else ""
        problems += [f"search: {title}: {word} is no word of the page" for word in words[:3] if plain(word) not in shown]
        if words:
            asked.append(" ".join(words[::5]))
            wanted.append(address)
    one = next(i for i, section in enumerate(sections) if len(section[2]) > 100)
    words = " ".join(sections[one][2].split()[:12])
    known = {"sphericity": 0, "touching_bodies": 1, "touching_bod": 1, "friction stiffness": 0}  # and the least number of sections
    hits = found(site, [*asked, words, *known])
    problems += [f"search: '{words}' does not find {to}" for words, to, there in zip(asked, wanted, hits) if to not in there]
    for (word, least), there in zip(known.items(), hits[-len(known):]):
        if len(there) < least or least == 0 and there:
            problems.append(f"search: '{word}' finds {len(there)} sections")
    unnoticed = sections[one][0] not in hits[len(asked)]
    unnoticed += sections[one][0] in found(site, [words], str(one))[0]
    return problems, len(asked), unnoticed


def main():
    if shutil.which("doxygen") is None:
        print("abut skips: doxygen is not there")
        return 0
    root, work = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    subprocess.run(["sh", root / "cmake/site.sh", work], check=True, stdout=subprocess.DEVNULL)
    site = work / "html"
    pages, index = read(site), index_of(site)
    problems = list(broken_links(site, pages)) + list(missing(root, pages, index))
    sections, unnoticed = 0, 0
    if shutil.which("node") is None:
        print("node is not there: the search of words was not run")
    else:
        more, sections, unnoticed = unfound(site, pages)
        problems += more
    for line in problems[:40]:
        print(line)
    links = sum(len(page.links) for page in pages.values())
    manual = pages["index.html"]
    for where, plant in ((manual.links, "page_docs_none.html"), (manual.links, "page_docs_viewer.html#none"), (manual.links, "files/none.txt"),
                         (manual.links, "file:none"), (manual.loads, "https://example.org/a.js")):
        where.append(plant)
        unnoticed += not list(broken_links(site, {"index.html": manual, "page_docs_viewer.html": pages["page_docs_viewer.html"]}))
        where.pop()
    kept, manual.text = manual.text, manual.text.replace("exactly", "", 1)
    unnoticed += len(list(missing(root, pages, index))) <= len(problems)
    manual.text = kept
    unnoticed += len(list(missing(root, pages, index.replace("make_bvh", "")))) <= len(problems)
    print(f"{len(pages)} pages, {links} links, {sections} sections: {len(problems)} problems, {unnoticed} plants unnoticed")
    return 1 if problems or unnoticed or links < 1000 else 0


if __name__ == "__main__":
    sys.exit(main())
