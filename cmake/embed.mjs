// node embed.mjs PAGE.html SOURCE.cpp: writes a C++ source file that holds the page as a string.
import { readFileSync, writeFileSync } from "node:fs";

const [, , page, source] = process.argv;
const bytes = readFileSync(page);

// Octal escapes have at most three digits, so a digit that follows one cannot be taken into it.
const escape = (byte) =>
    byte === 0x22 || byte === 0x5c || byte === 0x3f || byte < 0x20 || byte > 0x7e
        ? "\\" + byte.toString(8).padStart(3, "0")
        : String.fromCharCode(byte);

const lines = [];
for (let start = 0; start < bytes.length; start += 4000)
    lines.push('"' + Array.from(bytes.subarray(start, start + 4000), escape).join("") + '"');

writeFileSync(source, `#include "io/replay_template.hpp"

static constexpr char page[] =
${lines.join("\n")};

std::string_view carom::io::replay_template() { return {page, sizeof(page) - 1}; }
`);
