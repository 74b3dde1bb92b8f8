#!/usr/bin/python3
"""Builds the documentation as a site: docs/site/build.py OUT.

Writes OUT/html: every page with search (mkdocs), and the reference of the headers for policies (Doxygen). Afterwards
every link and anchor of the site is followed; a dead one is an error.
"""
import html.parser
import os
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse

MISSING = "docs/site/build.py needs mkdocs, mkdocs-material and doxygen: make docs installs them"
try:
    import yaml
except ImportError:
    sys.exit(MISSING)

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADERS = ["sdk/abi", "sdk/include", "sdk/testing"]
FRONT = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md", "LICENSE"]


def linked_pages(page, prefix):
    """The pages that the tables of `page` link in their first column, by heading: {heading: [(title, path)]}."""
    groups, heading = {}, None
    for line in page.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            heading = line[3:].split(":")[0]
        elif heading and (m := re.match(r"\| \[([^\]]+)\]\(([^)#]+\.md)\) \|", line)):
            groups.setdefault(heading, []).append((m[1].replace("`", ""), os.path.normpath(prefix + m[2])))
    return groups


def navigation():
    nav = [{"karst": ["README.md", {"All pages": "docs/README.md"}]}]
    for heading, pages in linked_pages(ROOT / "docs/README.md", "docs/").items():
        entries = [{title: path} for title, path in pages]
        if heading == "Reference":
            entries += [{p.stem: f"docs/policies/{p.name}"} for p in sorted((ROOT / "docs/policies").glob("[a-z]*.md"))]
            entries.append({"C and C++ headers": "reference/index.html"})
        nav.append({heading: entries})
    results = linked_pages(ROOT / "docs/results/README.md", "docs/results/")
    nav.append({"Results": ["docs/results/README.md"] +
                           [{h: [{t: p} for t, p in pages]} for h, pages in results.items()]})
    return nav


def stage(out):
    """The pages where mkdocs finds them: links between them stay as they are in the repository."""
    pages = out / "pages"
    for made in (pages, out / "html"):  # nothing else of the folder is ours
        shutil.rmtree(made, ignore_errors=True)
    pages.mkdir(parents=True)
    for name in FRONT:
        shutil.copy(ROOT / name, pages)
    shutil.copytree(ROOT / "docs", pages / "docs", ignore=shutil.ignore_patterns("*.py", "*.yml", "Doxyfile"))
    config = yaml.safe_load((ROOT / "docs/site/mkdocs.yml").read_text(encoding="utf-8"))
    config["nav"] = navigation()
    (out / "mkdocs.yml").write_text(yaml.safe_dump(config, sort_keys=False), encoding="utf-8")


def reference(out):
    settings = (ROOT / "docs/site/Doxyfile").read_text(encoding="utf-8")
    settings += f"INPUT = {' '.join(HEADERS)}\nOUTPUT_DIRECTORY = {out / 'pages'}\n"
    subprocess.run(["doxygen", "-"], input=settings, text=True, check=True, cwd=ROOT)


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.anchors, self.links = set(), []
        self.feed(path.read_text(encoding="utf-8", errors="replace"))

    def handle_starttag(self, tag, attrs):
        for key, value in attrs:
            if key in ("id", "name") and value:
                self.anchors.add(value)
            elif key in ("href", "src") and value and tag != "link":
                self.links.append(value)


def dead_links(site):
    pages = {p: Page(p) for p in site.rglob("*.html") if p.name != "404.html"}
    for path, page in sorted(pages.items()):
        if path.is_relative_to(site / "reference"):
            continue  # Doxygen links headings that it leaves out
        for link in page.links:
            url = urllib.parse.urlsplit(link)
            if url.scheme or url.netloc or link == "#":
                continue
            target = path if not url.path else (path.parent / urllib.parse.unquote(url.path)).resolve()
            if target.is_dir():
                target /= "index.html"
            anchor = urllib.parse.unquote(url.fragment)
            if not target.exists():
                yield f"{path.relative_to(site)}: {link}: there is no such page"
            elif anchor and target in pages and anchor not in pages[target].anchors:
                yield f"{path.relative_to(site)}: {link}: the page has no such heading"


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: docs/site/build.py OUT")
    if not (shutil.which("mkdocs") and shutil.which("doxygen")):
        sys.exit(MISSING)
    out = pathlib.Path(sys.argv[1]).resolve()
    stage(out)
    reference(out)
    subprocess.run(["mkdocs", "build", "--quiet", "--strict", "-f", out / "mkdocs.yml", "-d", out / "html"], check=True)
    dead = list(dead_links(out / "html"))
    for line in dead:
        print(line, file=sys.stderr)
    if dead:
        sys.exit(f"{len(dead)} dead links")
    print(f"{out / 'html/index.html'}: {len(list((out / 'html').rglob('*.html')))} pages, every link leads somewhere")


if __name__ == "__main__":
    main()
