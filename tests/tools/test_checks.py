"""Each check in tools/ passes over a small good tree and names the fault in a bad one."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

tools = pathlib.Path(__file__).resolve().parent.parent.parent / "tools"

good_header = """#pragma once

namespace carom {

/// A thing.
struct Thing {
    int size = 0;  ///< metres
};

/// Twice the size.
int twice(const Thing& thing);

}  // namespace carom
"""
good_source = """#include "carom/thing.hpp"

#include <vector>

namespace carom {

int twice(const Thing& thing) { return 2 * thing.size; }

}  // namespace carom
"""


def function_of(lines, head="int f(int x)"):
    return head + " {\n" + "    x += 1;\n" * (lines - 3) + "    return x;\n}\n"


class Check(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("include/carom/thing.hpp", good_header)
        self.write("src/math/thing.cpp", good_source)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def run_tool(self, name):
        command = [sys.executable, tools / name, "--root", self.root]
        return subprocess.run(command, capture_output=True, text=True)

    def passes(self, tool):
        result = self.run_tool(tool)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout

    def fails(self, tool, *words):
        result = self.run_tool(tool)
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        for word in words:
            self.assertIn(word, result.stdout)


class Layers(Check):
    def test_good(self):
        self.write("src/geometry/box.hpp", '#pragma once\n#include "math/inner.hpp"\n#include "carom/thing.hpp"\n')
        self.write("src/math/inner.hpp", "#pragma once\n#include <cmath>\n")
        self.write("src/io/scene.cpp", '#include <nlohmann/json.hpp>\n#include "geometry/box.hpp"\n')
        self.passes("check_layers")

    def test_upwards(self):
        self.write("src/math/bad.cpp", '#include "geometry/box.hpp"\n')
        self.write("src/geometry/box.hpp", "#pragma once\n")
        self.fails("check_layers", "src/math/bad.cpp:1: geometry/box.hpp is in a layer above math")

    def test_upwards_in_tests(self):
        self.write("tests/math/bad.cpp", '#include "world/step.hpp"\n')
        self.write("src/world/step.hpp", "#pragma once\n")
        self.fails("check_layers", "tests/math/bad.cpp:1:")

    def test_private_from_public(self):
        self.write("include/carom/bad.hpp", '#pragma once\n\n#include "math/inner.hpp"\n')
        self.fails("check_layers", "include/carom/bad.hpp:3: math/inner.hpp is private")

    def test_dependencies(self):
        self.write("src/world/bad.cpp", "#include <fmt/format.h>\n")
        self.write("include/carom/bad.hpp", "#include <CLI/CLI.hpp>\n")
        self.fails("check_layers", "src/world/bad.cpp:1: fmt/format.h", "include/carom/bad.hpp:1: CLI/CLI.hpp")

    def test_missing(self):
        self.write("src/world/bad.cpp", '#include "math/nowhere.hpp"\n#include "carom/nowhere.hpp"\n')
        self.fails("check_layers", "bad.cpp:1: math/nowhere.hpp does not", "bad.cpp:2: carom/nowhere.hpp does not")

    def test_sibling(self):
        self.write("src/math/bad.cpp", '#include "inner.hpp"\n')
        self.fails("check_layers", "is not named by its layer")

    def test_unknown_folder(self):
        self.write("src/utilities/bad.cpp", "\n")
        self.fails("check_layers", "src/utilities is not a layer")

    def test_commented_include(self):
        self.write("src/math/fine.cpp", '// #include "world/step.hpp"\n/*\n#include "world/step.hpp"\n*/\n')
        self.passes("check_layers")


class Sizes(Check):
    def test_good(self):
        self.assertNotIn("note", self.passes("check_sizes"))

    def test_files(self):
        self.write("src/math/warned.cpp", "\n" * 501)
        self.assertIn("warning: src/math/warned.cpp: 501 lines", self.passes("check_sizes"))
        self.write("src/math/long.cpp", "\n" * 601)
        self.write("src/math/long.hpp", "\n" * 401)
        self.fails("check_sizes", "src/math/long.cpp: 601 lines", "src/math/long.hpp: 401 lines")

    def test_functions(self):
        self.write("src/math/a.cpp", function_of(60) + function_of(61))
        self.assertIn("note: src/math/a.cpp:61: f has 61 lines", self.passes("check_sizes"))
        self.write("src/math/b.cpp", function_of(150, "static int g(int x)") + function_of(151))
        self.fails("check_sizes", "src/math/b.cpp:151: f has 151 lines")

    def test_functions_in_odd_clothes(self):
        heads = [
            "template <class T, class = std::vector<std::vector<T>>>\nint odd(T x)",
            "Odd::odd(int x) : a_{x}, b_(x), c_{{1, 2}}",
            "auto odd(int x) const noexcept -> std::vector<int>",
            "bool Odd::operator()(int x)",
            'TEST(Odd, odd)',
        ]
        for head in heads:
            self.write("src/math/a.cpp", f"namespace a {{\nclass B : C {{\npublic:\n{function_of(160, head)}}};\n}}\n")
            with self.subTest(head):
                self.fails("check_sizes", "lines, more than 150")

    def test_braces_in_literals(self):
        text = "int f(int x) {\n    return x + sizeof(\"}\") + '}' + 1'000; // }\n}\n"
        self.write("src/math/a.cpp", text + function_of(151))
        self.fails("check_sizes", "src/math/a.cpp:4: f has 151 lines")


class Headers(Check):
    def test_good(self):
        self.passes("check_headers")

    def test_does_not_compile(self):
        self.write("include/carom/bad.hpp", "#pragma once\n\nnamespace carom {\n\n/// Long.\nint f(std::string);\n\n}\n")
        self.fails("check_headers", "include/carom/bad.hpp: g++ alone", "string")

    def test_warns(self):
        self.write("include/carom/bad.hpp", "#pragma once\n\n/// Half.\ninline int f(int x) { return 1; }\n")
        self.fails("check_headers", "unused")

    def test_preprocessor(self):
        self.write("include/carom/bad.hpp", "#pragma once\n#ifdef FAST\n#define SPEED 2\n#endif\n")
        self.fails("check_headers", "bad.hpp:2: #ifdef", "bad.hpp:3: #define", "bad.hpp:4: #endif")

    def test_guard(self):
        self.write("include/carom/bad.hpp", "\n")
        self.fails("check_headers", "bad.hpp:1: lacks #pragma once")

    def test_undocumented(self):
        text = """#pragma once
#include <utility>
struct Bare {};

/// Fine.
class Fine {
  public:
    Fine() = default;
    /// Fine.
    explicit Fine(std::pair<int, int> sizes = {});

    ~Fine();
    Fine(Fine&&) noexcept;

    int bare_member() const;

    /// Fine.
    int one() const { return 1; }
    int two() const { return 2; }

  private:
    int hidden();
};

int bare();

/// Fine.
int overloaded(int x);

int overloaded(double x);
"""
        self.write("include/carom/bad.hpp", text)
        self.fails("check_headers", "bad.hpp:3:", "bad.hpp:15:", "bad.hpp:25:")
        found = self.run_tool("check_headers").stdout.count("has no docstring")
        self.assertEqual(found, 3)


class Hygiene(Check):
    def test_good(self):
        self.write("tool.sh", 'cp "$HOME/work/x" "$(mktemp -d)/home/x"\n')
        self.passes("check_hygiene")

    def test_bad(self):
        bad = {
            "a.md": "see /ho" + "me/somebody/carom",
            "b.sh": "cp x /t" + "mp/x",
            "package-lock.json": '"resol' + 'ved": "https://example.org/three.tgz"',
            "c.json": "https://registry.npm" + "js.org/three",
            "d.cpp": "// TO" + "DO: all",
            "e.md": "<" * 7 + " ours",
        }
        for name, text in bad.items():
            self.write(name, f"fine\n{text}\n")
        self.fails("check_hygiene", *(f"{name}:2:" for name in bad))

    def test_npm_settings(self):
        self.write("web/replay/.npmrc", "omit-lockfile-registry-resolved=true\n")
        self.passes("check_hygiene")
        self.write("web/replay/.npmrc", "registry=x\n")
        self.fails("check_hygiene", "web/replay/.npmrc")


class Determinism(Check):
    def test_good(self):
        self.write("src/math/fine.cpp", "// std::sin\ndouble f(double x) { return std::sqrt(x) + sin(x); }\n")
        self.write("src/io/clock.cpp", "auto t = std::chrono::steady_clock::now();\n")
        self.passes("check_determinism")

    def test_bad(self):
        self.write("src/math/bad.cpp", "double a = std::sin(1);\ndouble b = std::hypot(1, 2);\n")
        self.write("src/world/bad.cpp", "std::unordered_map<int, int> m;\nauto t = std::chrono::seconds(1);\n")
        self.write("include/carom/bad.hpp", "inline float f(float x) { return std::fma(x, x, x); }\n")
        self.fails("check_determinism", "math/bad.cpp:1:", "math/bad.cpp:2:", "world/bad.cpp:1:", "world/bad.cpp:2:",
                   "include/carom/bad.hpp:1:")


class Format(unittest.TestCase):
    def test_bad(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / ".clang-format").write_text((tools.parent / ".clang-format").read_text())
            (root / "fine.cpp").write_text("int x = 1;\n")
            subprocess.run(["git", "init", "--quiet"], cwd=root, check=True)
            environment = {"PATH": "/usr/bin:/bin", "CAROM_ROOT": folder}
            run = lambda: subprocess.run([tools / "check_format"], env=environment, capture_output=True, text=True)
            self.assertEqual(run().returncode, 0, run().stderr)
            (root / "bad.cpp").write_text("int   x=1 ;\n")
            self.assertEqual(run().returncode, 1)
            self.assertIn("bad.cpp:1", run().stderr)


if __name__ == "__main__":
    unittest.main()
