"""Each link of a document leads to a file, and each place of a document that texts and sources name is there."""

import re
import subprocess

from programs import TOP, demand

FILES = [TOP / name for name in subprocess.run(["git", "ls-files"], cwd=TOP, capture_output=True, text=True, check=True).stdout.splitlines()]
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
# A place: methods.md, "Bad rows".  In a comment the name may continue on the next line.
PLACE = re.compile(r"([\w-]+\.md)\)?,?\s(?:///?\s)?\"([^\"\n]+)\"")
MANUAL = re.compile(r"(a351[\w.-]*)\((\d)\), ([A-Z]{3}[A-Z ]+[A-Z])")
HEADING = re.compile(r"^(?:#+ |\*\*)(.*?)(?:\.?\*\*|$)", re.MULTILINE)


def names_of(page):
    return {re.sub(r" \(.*|:.*|`", "", name).strip().rstrip(".") for name in HEADING.findall(page.read_text())}


pages = {path.name: path for path in FILES if path.suffix == ".md" and path.name != "README.md"}
dead = [f"{page.relative_to(TOP)}: {link}" for page in FILES if page.suffix == ".md"
        for link in LINK.findall(page.read_text()) if "://" not in link and not (page.parent / link).exists()]
demand(f"every link of a page leads to a file; not {dead}", not dead)
# Pages of tests/golden name files of other projects, and CODE is a place holder.
shown = [(page, file) for page in FILES if page.suffix == ".md" and "golden" not in page.parts
         for file in re.findall(r"`((?:[\w-]+/)+[\w.-]+\.(?:cpp|hpp|py|md|po|sh|cmake))`", page.read_text())]
lost = [f"{page.relative_to(TOP)}: {file}" for page, file in shown if "CODE" not in file and not any(str(path).endswith(f"/{file}") for path in FILES)]
demand(f"each of {len(shown)} source files that pages name is there; not {lost}", shown and not lost)
texts = [path for path in FILES if path.suffix in {".md", ".hpp", ".cpp", ".py"} or path.suffix[1:].isdigit()]
named = [(path, page, name) for path in texts for page, name in PLACE.findall(path.read_text()) if page in pages]
lost = [f"{path.relative_to(TOP)}: {page}, \"{name}\"" for path, page, name in named if name not in names_of(pages[page])]
demand(f"each of {len(named)} places of documents that are named is there; not {lost}", named and not lost)
manuals = {path.name: path.read_text() for path in FILES if path.suffix[1:].isdigit() and path.name.startswith("a351")}
cited = [(path, f"{page}.{chapter}", name) for path in texts for page, chapter, name in MANUAL.findall(path.read_text())]
lost = [f"{path.relative_to(TOP)}: {page}, {name}" for path, page, name in cited
        if not re.search(rf'^\.S[HS] "?{name}"?$', manuals.get(page, ""), re.MULTILINE)]
demand(f"each of {len(cited)} sections of manual pages that are named is there; not {lost}", cited and not lost)
