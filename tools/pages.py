#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Makes the documentation as web pages: README, CHANGELOG, CONTRIBUTING and docs, with what they link to.

    tools/pages.py OUT [--man FILE]

OUT becomes a folder with index.html, which is README. --man adds the man page. It needs cmark-gfm (Debian's package). A link to a file or
a heading that is not there is an error.
"""
import argparse
import html
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).resolve().parent.parent
TOP = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md"]
STYLE = """body { max-width: 60rem; margin: 2rem auto; padding: 0 1rem; font: 16px/1.5 sans-serif; color: #222; }
pre, code { font: 14px/1.4 monospace; background: #f4f4f4; } pre { padding: .6rem; overflow-x: auto; }
table { border-collapse: collapse; } td, th { border: 1px solid #ccc; padding: .2rem .5rem; } img { max-width: 100%; }
"""
PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{title}</title>
<link rel="stylesheet" href="{up}style.css"></head><body><p><a href="{up}index.html">Caplet {version}</a></p>
{body}</body></html>
"""


def slug(heading):
    """The name that GitHub gives a heading; `heading` is HTML."""
    text = html.unescape(re.sub(r"<[^>]*>", "", heading)).lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def page_name(path):
    return "index.html" if path == "README.md" else str(PurePosixPath(path).with_suffix(".html"))


class Site:
    def __init__(self, root):
        self.root = root
        docs = sorted(str(path.relative_to(root)) for path in (root / "docs").rglob("*.md"))
        self.pages = {path: self.body_of(path) for path in TOP + docs}
        self.names = {path: set(re.findall(r'<h[1-6] id="([^"]*)"', body)) for path, body in self.pages.items()}
        self.files, self.errors = set(), []

    def body_of(self, path):
        done = subprocess.run(["cmark-gfm", "--unsafe", "-e", "table", "-e", "autolink", self.root / path], check=True, capture_output=True,
                              text=True)
        seen = {}

        def name(match):
            base = slug(match[2])
            count = seen[base] = seen.get(base, -1) + 1
            return f'<h{match[1]} id="{base}{f"-{count}" if count else ""}">{match[2]}</h{match[1]}>'

        return re.sub(r"<h([1-6])>(.*?)</h\1>", name, done.stdout, flags=re.S)

    def link(self, page, target):
        """The target of a link of `page` on the site."""
        if re.match(r"[a-z]+:", target):
            return target
        path, _, name = html.unescape(target).partition("#")
        to = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
        if to in self.pages:
            if name and name not in self.names[to]:
                self.errors.append(f"{page}: {to} has no heading #{name}")
            to = page_name(to)
        elif (self.root / to).is_file():
            self.files.add(to)
        elif not (self.root / to).is_dir() or to.startswith(".."):
            self.errors.append(f"{page}: there is no {to}")
        start = os.path.dirname(page_name(page)) or "."
        return html.escape(os.path.relpath(to, start) + (f"#{name}" if name else ""))

    def write(self, out, version):
        for page, body in self.pages.items():
            body = re.sub(r'(href|src)="([^"]*)"', lambda match: f'{match[1]}="{self.link(page, match[2])}"', body)
            title = re.search(r"<h1[^>]*>(.*?)</h1>", body, re.S)
            file = out / page_name(page)
            file.parent.mkdir(parents=True, exist_ok=True)
            title = re.sub(r"<[^>]*>", "", title[1]) if title else "Caplet"
            file.write_text(PAGE.format(title=title, up="../" * page.count("/"), version=version, body=body))
        for name in self.files:
            (out / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(self.root / name, out / name)
        (out / "style.css").write_text(STYLE)
        return self.errors


def make(root, out, version, man=None):
    """Makes the site of the sources in `root`. Returns what is wrong with its links."""
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    if man:
        shutil.copyfile(man, out / "caplet.1")
    return Site(root).write(out, version)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("out", type=Path)
    parser.add_argument("--man", type=Path)
    options = parser.parse_args()
    version = re.search(r"project\(caplet VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    errors = make(ROOT, options.out, version, options.man)
    for error in errors:
        print(f"pages: {error}", file=sys.stderr)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
