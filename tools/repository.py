"""What the checks in this folder share: the files of the repository, C++ without its comments, reporting."""

import argparse
import pathlib
import re
import subprocess
import sys

layers = ["core", "math", "simd", "geometry", "collision", "dynamics", "solver", "joints", "world", "parts", "io"]
engine_layers = layers[:-1]


def arguments(description):
    """Reads the command line that all checks have in common: the root of the tree to look at."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    return parser.parse_args()


def files(root, *endings):
    """All files below root with one of the endings (all files for none); in a git work tree those that git
    tracks or would add. Sorted, relative to root."""
    if (root / ".git").exists():
        command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
        listing = subprocess.run(command, cwd=root, capture_output=True, check=True).stdout.decode()
        names = {name for name in listing.split("\0") if name and (root / name).is_file()}
    else:
        names = {str(path.relative_to(root)) for path in root.rglob("*") if path.is_file()}
    return sorted(name for name in names if not endings or name.endswith(endings))


def cpp_files(root):
    return files(root, ".hpp", ".cpp")


tokens_to_blank = re.compile(
    r"""(?P<line>//[^\n]*)
      | (?P<block>/\*.*?\*/)
      | (?P<raw>R"(?P<delimiter>[^\s()\\]{0,16})\(.*?\)(?P=delimiter)")
      | (?P<string>"(?:\\.|[^"\\\n])*")
      | (?P<number>\b[0-9][0-9a-zA-Z_.]*(?:'[0-9a-zA-Z]+)+)
      | (?P<character>'(?:\\.|[^'\\\n])+')""",
    re.VERBOSE | re.DOTALL,
)


def without_comments_and_strings(text):
    """The same text with comments and the insides of literals blanked; line numbers stay."""

    def blank(match):
        if match.lastgroup == "number":
            return match.group()
        kept = re.sub(r"[^\n]", " ", match.group())
        if match.group("line") or match.group("block"):
            return kept
        return '"' + kept[1:-1] + '"'

    return tokens_to_blank.sub(blank, text)


def finish(name, faults, summary):
    """Prints what was found and ends the program: status 1 if there is a fault."""
    for fault in faults:
        print(fault)
    if faults:
        sys.exit(f"{name}: {len(faults)} fault{'s' if len(faults) > 1 else ''}")
    print(f"{name}: {summary}")
