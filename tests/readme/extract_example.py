"""extract_example.py README.md PROGRAM.cpp: writes the first block of C++ in the text to a source file."""

import pathlib
import re
import sys

readme, program = map(pathlib.Path, sys.argv[1:])
block = re.search(r"^```cpp\n(.*?)^```$", readme.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
if not block:
    sys.exit(f"{readme} has no block of C++")
program.write_text(block[1], encoding="utf-8")
