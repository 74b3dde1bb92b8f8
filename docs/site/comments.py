#!/usr/bin/python3
"""Doxygen's filter: turns the plain comments of karst's headers into comments that Doxygen reads.

The block at the top of a header describes the file. A comment after a declaration belongs to that declaration,
any other to the one that follows.
"""
import re
import sys


def documented(text):
    # C: /* ... */
    text = re.sub(r"^/\*(?!\*)\s*\n?", "/** \\\\file\n", text, count=1) if text.startswith("/*") else text
    text = re.sub(r"^([^\n/]*[;,{][ \t]*)/\*(?!\*)", r"\1/**<", text, flags=re.M)
    text = re.sub(r"^([ \t]*)/\*(?!\*)", r"\1/**", text, flags=re.M)
    # C++: // ...
    if top := re.match(r"(//(?!/)[^\n]*\n)+", text):
        text = "/// \\file\n" + re.sub(r"^//", "///", top.group(), flags=re.M) + text[top.end():]
    text = re.sub(r"^([ \t]*///)   (?=\S| )", r"\1      ", text, flags=re.M)  # indented lines are code
    return re.sub(r"^([^\n/]*[;,][ \t]*)//(?!/)", r"\1///<", text, flags=re.M)


if __name__ == "__main__":
    sys.stdout.write(documented(open(sys.argv[1], encoding="utf-8").read()))
