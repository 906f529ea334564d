#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the pages of README.md and docs/ ready for Doxygen: usage: site.py ROOT FOLDER VERSION LUNR

Writes each page to FOLDER/pages and what it links to, other than pages, to FOLDER/files, and FOLDER/Doxyfile, which reads them and
the headers. The text of all pages goes to FOLDER/search_sections.js, in which a page of its own looks (search.js) with LUNR, lunr.js. Doxygen has other rules than GitHub, whose pages these are. So each heading gets a label of its own, links to pages and
headings name these labels, and what Doxygen takes for a command is written so that it is none.
"""

import json
import os
import re
import shutil
import sys
from pathlib import Path

FENCE = re.compile(r"^ *```")
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\[\]]*\]|\n)*?)\]\(([^()\s]+)\)")
CODE = re.compile(r"(`+)(.+?)\1", re.DOTALL)


def label_of(page, anchor=""):
    name = re.sub(r"\W", "_", str(page.with_suffix("")))
    return f"page_{name}" + (f"__{re.sub(r'[^a-z0-9_-]', '_', anchor)}" if anchor else "")


def words_of(text):
    """The words of a piece of a page that a reader sees, with spaces between."""
    text = re.sub(r"<!--.*?-->|</?[a-z][^>\n]*>|^ *```.*$", " ", text, flags=re.DOTALL | re.MULTILINE)
    return " ".join(re.findall(r"[A-Za-z0-9_]+", LINK.sub(r"\2", text)))


def slugs():
    """The anchor of each heading in turn, as GitHub makes them."""
    seen = {}

    def slug_of(heading):
        heading = re.sub(r"\[(.*?)\]\(.*?\)", r"\1", heading).replace("`", "")
        slug = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        return f"{slug}-{count}" if count else slug

    return slug_of


class Site:
    def __init__(self, root, folder):
        self.root, self.folder, self.sections = root, folder, []
        self.pages = [Path("README.md")] + sorted(path.relative_to(root) for path in (root / "docs").rglob("*.md"))
        self.pages.remove(Path("docs/reference/index.md"))  # the reference's own page, which Doxygen reads as it is

    def target_of(self, page, target, is_picture):
        """Where a link leads in the site; what is no page is brought along."""
        if re.match(r"[a-z]+:", target):
            return target
        path, _, anchor = target.partition("#")
        path = Path(os.path.normpath(page.parent / path)) if path else page
        if path == Path("docs/reference/index.md"):
            return "@ref reference"
        if path in self.pages:
            return f"@ref {label_of(path, anchor)}"
        if path == Path("docs"):
            return f"@ref {label_of(Path('docs/README.md'))}"
        to = self.folder / "files" / path
        to.parent.mkdir(parents=True, exist_ok=True)
        if (self.root / path).is_file():
            if path.suffix in (".png", ".svg", ".html"):
                shutil.copyfile(self.root / path, to)
                return f"files/{path}"
            # A browser shows text; what it would ask to save gets an ending that says so.
            shutil.copyfile(self.root / path, f"{to}.txt")
            return f"files/{path}.txt"
        if (self.root / path).is_dir():
            names = sorted(child.name for child in (self.root / path).iterdir())
            Path(f"{to}.txt").write_text("\n".join(names) + "\n", encoding="utf-8")
            return f"files/{path}.txt"
        sys.exit(f"site.py: {page}: {target} is not there")

    def linked(self, page, text):
        """A piece of text without blocks of code."""
        kept = []

        def keep(made):
            kept.append(made)
            return f"\0{len(kept) - 1}\0"

        # Within one backquote Doxygen takes an apostrophe for the end. Within two nothing has a meaning.
        def code(match):
            return keep(f"``{' '.join(match[2].split())}``")

        text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
        text = CODE.sub(code, text)

        def link(match):
            is_picture, words, target = match[1] == "!", " ".join(match[2].split()), match[3]
            to = self.target_of(page, target, is_picture)
            if is_picture:
                return keep(f'<img src="{to}" alt="{words}">')
            if to.startswith("@ref "):
                return keep(f"[{words}](") + keep(f"{to})")
            return keep(f'<a href="{to}">') + words + keep("</a>")

        while True:  # a picture may be within a link
            changed = LINK.sub(link, text)
            if changed == text:
                break
            text = changed
        text = re.sub(r"(?<![\w\\])@(?=\w)", "&#64;", text)
        text = re.sub(r"\\(?=[\w])", "&#92;", text)
        while "\0" in text:
            text = re.sub("\0(\\d+)\0", lambda m: kept[int(m[1])], text)
        return text

    def write(self, page):
        slug_of, first = slugs(), True
        made, prose, in_code, sections = [], [], False, []
        address = "index.html" if page == Path("README.md") else f"{label_of(page)}.html"

        def flush():
            if prose:
                made.append(self.linked(page, "\n".join(prose)))
                prose.clear()

        for line in (self.root / page).read_text(encoding="utf-8").split("\n"):
            heading = None if in_code else re.match(r"^(#+) (.*?)\s*$", line)
            if sections and not heading:
                sections[-1][2].append(line)
            if FENCE.match(line):
                if not in_code:
                    flush()
                in_code = not in_code
                made.append(line.replace("```cpp", "```{.cpp}").replace("```sh", "```{.sh}"))
            elif in_code:
                made.append(line)
            elif heading:
                flush()
                anchor = slug_of(heading[2])
                title = re.sub(r"\[(.*?)\]\(.*?\)", r"\1", heading[2]).replace("`", "").replace("<", "&lt;")
                label = label_of(page) if first else label_of(page, anchor)
                made.append(f"{heading[1]} {title} {{#{label}}}")
                shown = title.replace("&lt;", "<")
                sections.append((address if first else f"{address}#{label}", shown if first else f"{sections[0][1]}: {shown}", []))
                if first:
                    made.append(f'\n<a id="{label_of(page, anchor)}"></a>')
                first = False
            else:
                prose.append(line)
        flush()
        name = self.folder / "pages" / f"{label_of(page)}.md"
        name.parent.mkdir(parents=True, exist_ok=True)
        name.write_text("\n".join(made), encoding="utf-8")
        self.sections += [(to, shown, words_of("\n".join(lines))) for to, shown, lines in sections]


SEARCH = """# Search the text {#search_text}

Words of the manual, the evidence and the proofs. Names of the library are found by the field at the top right.

@htmlonly
<input id="search_words" type="search" size="60" aria-label="words to look for"> <span id="search_count" role="status"></span>
<ul id="search_found"></ul>
<script src="lunr.js"></script>
<script src="search_sections.js"></script>
<script src="search_text.js"></script>
<script>show_search();</script>
@endhtmlonly
"""


def main():
    root, folder, version, lunr = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), sys.argv[3], sys.argv[4]
    for part in ("pages", "files", "html"):
        shutil.rmtree(folder / part, ignore_errors=True)
    site = Site(root, folder)
    for page in site.pages:
        site.write(page)
    reference = (root / "docs/reference/index.md").read_text(encoding="utf-8")
    (folder / "pages/reference.md").write_text(reference.replace("# abut {#mainpage}", "# Reference {#reference}"), encoding="utf-8")
    (folder / "pages/search_text.md").write_text(SEARCH, encoding="utf-8")
    front = folder / f"pages/{label_of(Path('README.md'))}.md"
    front.write_text(front.read_text(encoding="utf-8") + "\n[Search the text of all pages](@ref search_text).\n", encoding="utf-8")
    scripts = folder / "scripts"
    scripts.mkdir(exist_ok=True)
    shutil.copyfile(lunr, scripts / "lunr.js")
    shutil.copyfile(root / "docs/reference/search.js", scripts / "search_text.js")
    (scripts / "search_sections.js").write_text(f"var search_sections = {json.dumps(site.sections)};\n", encoding="utf-8")
    extra = " ".join(f'"{path}"' for path in sorted(scripts.iterdir()))
    (folder / "Doxyfile").write_text((root / "docs/reference/Doxyfile").read_text(encoding="utf-8") + f"""
PROJECT_NUMBER         = {version}
OUTPUT_DIRECTORY       = "{folder}"
INPUT                  = include/abut "{folder}/pages"
FILE_PATTERNS          = *.hpp *.md
USE_MDFILE_AS_MAINPAGE = "{folder}/pages/{label_of(Path('README.md'))}.md"
GENERATE_XML           = NO
GENERATE_TREEVIEW      = YES
SEARCHENGINE           = YES
SERVER_BASED_SEARCH    = NO
HTML_EXTRA_FILES       = {extra}
TOC_INCLUDE_HEADINGS   = 2
STRIP_CODE_COMMENTS    = NO
WARN_AS_ERROR          = NO
""", encoding="utf-8")


if __name__ == "__main__":
    main()
