#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Turns a file of the project into what Doxygen reads, on standard output: a filter for Doxyfile.

Guides: Doxygen 1.9.4 knows no anchors like GitHub's, so each heading gets one, and links refer to
them. Links to other files of the project lead to copies of them, which scripts/docs makes.
Device headers: only the public macros stay, with their comments. Headers: Doxygen lists the macros
of files that are documented.

With --linked, prints the files that the guides link to, one a line.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PUBLIC_MACRO = re.compile(r"#define (cellist_(?!view_of|of_type)\w+|CELLIST_LISTS|CELLIST_PASS)"
                          r"\(([\w, .]*)\)")
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)")


parents = set()  # (README, page) of links that are subpages


def guides():
    return [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md"))]


def page_of(path):
    if path == ROOT / "README.md":
        return "mainpage"
    return "page-" + str(path.relative_to(ROOT)).removesuffix(".md").replace("/", "-").lower()


def slug_of(heading):
    text = LINK.sub(r"\2", heading).replace("`", "").lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def target_of(guide, link):
    """Returns the file that a relative link leads to, and the anchor in it."""
    name, _, anchor = link.partition("#")
    return (guide.parent / name).resolve() if name else guide, anchor


def is_external(link):
    return re.match(r"[a-z]+:", link) is not None


def rewritten(guide, match):
    image, text, link = match.groups()
    text = text.replace("`", "").replace("\n", " ")
    if image or is_external(link):
        return match.group(0)
    target, anchor = target_of(guide, link)
    if target.suffix == ".md" and target in guides():
        if not anchor and guide.name == "README.md" and (guide, target) not in parents:
            # The tree of pages: a README has the pages of its folder and of folders in it.
            parents.add((guide, target))
            if target.parent in (guide.parent, guide.parent / "docs", guide.parent / "adr"):
                return f'@subpage {page_of(target)} "{text}"'
        return f"[{text}](@ref {page_of(target)}{'-' + anchor if anchor else ''})"
    if target.is_file():
        return f"[{text}](source/{target.relative_to(ROOT)}.txt)"
    return text


def filter_guide(guide):
    used = {}
    is_first = True
    # Text and blocks of code in turn. Links may go on in the next line.
    for i, part in enumerate(re.split(r"^(```.*?^```$)", guide.read_text(), flags=re.M | re.S)):
        if i % 2:
            yield re.sub(r"^```(c|sh|json|cmake)$", r"```{.\1}", part, count=1, flags=re.M)
            continue
        for line in LINK.sub(lambda match: rewritten(guide, match), part).split("\n"):
            heading = re.match(r"(#+) (.*)", line)
            if not heading:
                yield line
                continue
            slug = slug_of(heading[2])
            used[slug] = used.get(slug, -1) + 1
            anchor = page_of(guide)
            if not is_first:
                anchor += "-" + slug + (f"-{used[slug]}" if used[slug] else "")
            is_first = False
            yield f"{heading[1]} {heading[2]} {{#{anchor}}}"


def filter_device_header(path):
    """Keeps the public macros and their comments."""
    yield "/// @file"
    yield "/// The device API: insert records into per-cell lists, and read the lists."
    yield ""
    comment = []  # of the macros that follow
    # Without the continuation of macros.
    text = re.sub(r"\\\n.*?$(?<!\\)", "", path.read_text(), flags=re.M | re.S)
    for line in text.splitlines():
        if line.startswith("// ") and not line.startswith("// ----"):
            comment.append(line)
            continue
        macro = PUBLIC_MACRO.match(line)
        if macro and comment:
            yield from ("/" + text for text in comment)
            yield f"#define {macro[1]}({macro[2]})"
        if not macro:
            comment = []


def main():
    if sys.argv[1:] == ["--linked"]:
        linked = set()
        for guide in guides():
            for _, _, link in LINK.findall(guide.read_text()):
                if not is_external(link):
                    linked.add(target_of(guide, link)[0])
        for path in sorted(linked):
            if path.is_file() and path.suffix != ".md":
                print(path.relative_to(ROOT))
        return
    path = Path(sys.argv[1]).resolve()
    if path.suffix == ".hpp":
        print(path.read_text().replace("#pragma once", "/** @file */", 1), end="")
        return
    lines = filter_guide(path) if path.suffix == ".md" else filter_device_header(path)
    print("\n".join(lines))


main()
