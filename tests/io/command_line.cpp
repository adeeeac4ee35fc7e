#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "io/replay_template.hpp"
#include "support.hpp"

namespace carom::io {
namespace {

using nlohmann::json;

struct Outcome {
    int status = -1;
    std::string out, error;
};

/// Runs the program with arguments as a shell takes them.
Outcome carom(const TestFolder& folder, const std::string& arguments) {
    const std::string out = folder.path("out.txt"), error = folder.path("error.txt");
    const std::string command =
        std::string("'") + CAROM_PROGRAM + "' " + arguments + " >'" + out + "' 2>'" + error + "'";
    const int status = std::system(command.c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_text(out), file_text(error)};
    std::filesystem::remove(out);
    std::filesystem::remove(error);
    return outcome;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::vector<std::string> keys_of(const std::string& text) {
    std::vector<std::string> keys;
    const auto object = nlohmann::ordered_json::parse(text);
    for (const auto& [key, value] : (object.is_array() ? object[0] : object).items()) keys.push_back(key);
    return keys;
}

const std::string falling_2 = scene_text(2, R"("name": "fall", "bodies": [
    {"name": "floor", "type": "fixed", "shapes": [{"type": "box", "size": [20, 1], "center": [0, -0.5]}]},
    {"name": "a, \"b\"", "position": [0, 3], "angle": 0.25, "shapes": [{"type": "box", "size": [1, 1]}]},
    {"position": [3, 3], "shapes": [{"type": "ball", "radius": 0.5}]}])");
const std::string falling_3 = scene_text(3, R"("bodies": [
    {"name": "floor", "type": "fixed", "shapes": [{"type": "plane", "normal": [0, 1, 0], "offset": 0}]},
    {"name": "crate", "position": [0, 3, 0], "shapes": [{"type": "box", "size": [1, 1, 1]}]}])");

TEST(CommandLine, run_prints_a_summary) {
    const TestFolder folder;
    const std::string scene = folder.write("scene.json", falling_2);
    const Outcome run = carom(folder, "run " + scene + " --steps 30");
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.error, "");
    EXPECT_NE(run.out.find("fall (2D)"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("bodies 3, shapes 3"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("steps 30"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("awake 2: 2 moving"), std::string::npos) << run.out;
    const Outcome quiet = carom(folder, "run " + scene + " --quiet");
    EXPECT_EQ(quiet.status, 0);
    EXPECT_EQ(quiet.out + quiet.error, "");
}

TEST(CommandLine, run_as_json) {
    const TestFolder folder;
    const std::string scene = folder.write("scene.json", falling_3);
    const Outcome run = carom(folder, "run " + scene + " --steps 90 --threads 2 --json");
    ASSERT_EQ(run.status, 0) << run.error;
    EXPECT_EQ(keys_of(run.out),
              (std::vector<std::string>{"name", "dimension", "bodies", "shapes", "contacts", "joints",
                                        "steps", "threads", "ms_per_step", "ms_per_step_worst",
                                        "energy_start", "energy_end", "hash"}));
    const json summary = json::parse(run.out);
    EXPECT_EQ(summary["name"], "scene");
    EXPECT_EQ(summary["dimension"], 3);
    EXPECT_EQ(summary["bodies"], 2);
    EXPECT_EQ(summary["contacts"], 1);
    EXPECT_EQ(summary["steps"], 90);
    EXPECT_EQ(summary["threads"], 2);
    EXPECT_GT(summary["ms_per_step"].get<double>(), 0);
    EXPECT_GE(summary["ms_per_step_worst"], summary["ms_per_step"]);
    EXPECT_NEAR(summary["energy_start"].get<double>(), 1000 * 9.81 * 3, 1e-6);
    EXPECT_NEAR(summary["energy_end"].get<double>(), 1000 * 9.81 * 0.5, 50);
    const std::string hash = summary["hash"];
    EXPECT_EQ(hash.size(), 16u);
    EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_EQ(json::parse(carom(folder, "run " + scene + " --steps 90 --json").out)["hash"], hash);
    EXPECT_NE(json::parse(carom(folder, "run " + scene + " --steps 20 --json").out)["hash"], hash);
}

TEST(CommandLine, run_without_steps) {
    const TestFolder folder;
    const std::string scene = folder.write("scene.json", falling_3);
    EXPECT_EQ(json::parse(carom(folder, "run " + scene + " --json").out)["steps"], 600);
    const json none = json::parse(carom(folder, "run " + scene + " --json --steps 0").out);
    EXPECT_EQ(none["steps"], 0);
    EXPECT_EQ(none["energy_start"], none["energy_end"]);
}

TEST(CommandLine, trace_in_the_plane) {
    const TestFolder folder;
    const std::string scene = folder.write("scene.json", falling_2), trace = folder.path("t.csv");
    ASSERT_EQ(carom(folder, "run " + scene + " --steps 2 --trace " + trace).status, 0);
    const auto lines = lines_of(file_text(trace));
    ASSERT_EQ(lines.size(), 1u + 3 * 3);
    EXPECT_EQ(lines[0], "step,time,body,x,y,angle,vx,vy,w");
    EXPECT_EQ(lines[1], "0,0,floor,0,-0.5,0,0,0,0");
    EXPECT_EQ(lines[2].substr(0, 17), "0,0,\"a, \"\"b\"\"\",0,");
    EXPECT_EQ(lines[3], "0,0,#2,3,3,0,0,0,0");
    EXPECT_EQ(lines[6].substr(0, 26), "1,0.016666666666666666,#2,");
    // The third step: 3 − g h² for a free fall of two steps, and −2 g h; written so that they come back
    // exactly.
    std::istringstream fields(lines[9]);
    std::vector<std::string> row;
    for (std::string field; std::getline(fields, field, ',');) row.push_back(field);
    ASSERT_EQ(row.size(), 9u);
    EXPECT_NEAR(std::stod(row[4]), 3 - 2 * 9.81 / 3600, 1e-12);
    EXPECT_NEAR(std::stod(row[7]), -2 * 9.81 / 60, 1e-12);
}

TEST(CommandLine, trace_in_space) {
    const TestFolder folder;
    const std::string scene = folder.write("scene.json", falling_3), trace = folder.path("t.csv");
    ASSERT_EQ(carom(folder, "run " + scene + " --steps 1 --trace " + trace).status, 0);
    const auto lines = lines_of(file_text(trace));
    ASSERT_EQ(lines.size(), 5u);
    EXPECT_EQ(lines[0], "step,time,body,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz");
    EXPECT_EQ(lines[2], "0,0,crate,0,3,0,0,0,0,1,0,0,0,0,0,0");
}

TEST(CommandLine, trace_of_chosen_bodies) {
    const TestFolder folder;
    const std::string scene = folder.write("scene.json", falling_2), trace = folder.path("t.csv");
    ASSERT_EQ(carom(folder, "run " + scene + " --steps 1 --trace-bodies '#2,floor' --trace " + trace).status,
              0);
    const auto lines = lines_of(file_text(trace));
    ASSERT_EQ(lines.size(), 5u);
    EXPECT_EQ(lines[1].substr(0, 10), "0,0,floor,");
    EXPECT_EQ(lines[2].substr(0, 7), "0,0,#2,");

    const std::string other = folder.path("other.csv");
    const Outcome wrong = carom(folder, "run " + scene + " --trace-bodies flor --trace " + other);
    EXPECT_EQ(wrong.status, 2);
    EXPECT_NE(wrong.error.find("\"flor\" is not a body of this scene (did you mean \"floor\"?)"),
              std::string::npos)
        << wrong.error;
    EXPECT_FALSE(std::filesystem::exists(other) || std::filesystem::exists(other + ".part"));
    EXPECT_EQ(carom(folder, "run " + scene + " --trace-bodies floor").status, 2);  // of which trace?
}

TEST(CommandLine, outputs_do_not_change_the_run) {
    if (replay_template().empty()) GTEST_SKIP() << "the replay viewer is not built in";
    const TestFolder folder;
    const std::string scene = folder.write("scene.json", falling_2);
    const auto hash = [&](const std::string& more) {
        return json::parse(carom(folder, "run " + scene + " --json --steps 60" + more).out)["hash"];
    };
    EXPECT_EQ(hash(""),
              hash(" --threads 8 --trace " + folder.path("t.csv") + " --replay " + folder.path("r.html")));
    EXPECT_GT(std::filesystem::file_size(folder.path("r.html")), 1000u);
    EXPECT_NE(file_text(folder.path("r.html")).find("fall"), std::string::npos);
}

TEST(CommandLine, outputs_that_cannot_be_written) {
    if (replay_template().empty()) GTEST_SKIP() << "the replay viewer is not built in";
    const TestFolder folder;
    const std::string scene = folder.write("scene.json", falling_2);
    for (const std::string option : {"--trace", "--replay"}) {
        const Outcome missing = carom(folder, "run " + scene + " " + option + " " + folder.path("none/file"));
        EXPECT_EQ(missing.status, 2);
        EXPECT_EQ(missing.error, "carom: " + option.substr(2) + " file '" + folder.path("none/file") +
                                     "' cannot be written: No such file or directory\n");
        const Outcome folder_itself = carom(folder, "run " + scene + " " + option + " " + folder.path(""));
        EXPECT_EQ(folder_itself.status, 2);
        EXPECT_NE(folder_itself.error.find("Is a directory"), std::string::npos) << folder_itself.error;
        const Outcome full = carom(folder, "run " + scene + " " + option + " /dev/full");
        EXPECT_EQ(full.status, 2);
        EXPECT_NE(full.error.find("No space left on device"), std::string::npos) << full.error;
    }
    EXPECT_EQ(std::system(
                  (std::string("'") + CAROM_PROGRAM + "' run " + scene + " >/dev/full 2>/dev/null").c_str()),
              2 << 8);
    std::filesystem::remove(scene);
    EXPECT_TRUE(folder.empty());  // nothing half-written is left
}

TEST(CommandLine, a_failed_run_leaves_the_file_that_was_there) {
    const TestFolder folder;
    const std::string scene = folder.write("scene.json", falling_2),
                      trace = folder.write("t.csv", "precious");
    EXPECT_EQ(carom(folder, "run " + scene + " --trace-bodies none --trace " + trace).status, 2);
    EXPECT_EQ(file_text(trace), "precious");
    EXPECT_EQ(carom(folder, "run " + scene + " --trace " + trace).status, 0);
    EXPECT_NE(file_text(trace), "precious");
}

TEST(CommandLine, a_trace_to_the_standard_output_stands_before_the_summary) {
    const TestFolder folder;
    const std::string scene = folder.write("scene.json", falling_2);
    const auto lines = lines_of(carom(folder, "run " + scene + " --steps 1 --trace /dev/stdout").out);
    ASSERT_GT(lines.size(), 8u);
    EXPECT_EQ(lines[0], "step,time,body,x,y,angle,vx,vy,w");
    EXPECT_EQ(lines[7], "fall (2D)");
}

TEST(CommandLine, a_link_is_followed) {
    const TestFolder folder;
    const std::string scene = folder.write("scene.json", falling_2), trace = folder.write("t.csv", "");
    std::filesystem::create_symlink(trace, folder.path("link.csv"));
    EXPECT_EQ(carom(folder, "run " + scene + " --trace " + folder.path("link.csv")).status, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link.csv")));
    EXPECT_EQ(file_text(trace).substr(0, 9), "step,time");
}

TEST(CommandLine, bad_scenes) {
    const TestFolder folder;
    const Outcome missing = carom(folder, "run " + folder.path("none.json"));
    EXPECT_EQ(missing.status, 2);
    EXPECT_EQ(missing.error,
              "carom: " + folder.path("none.json") + ": cannot be read: No such file or directory\n");
    const std::string bad = folder.write("bad.json", shape_text(2, "\"type\": \"ball\", \"radius\": -1"));
    for (const std::string command : {"run ", "check "}) {
        const Outcome outcome = carom(folder, command + bad);
        EXPECT_EQ(outcome.status, 2);
        EXPECT_EQ(outcome.out, "");
        EXPECT_EQ(outcome.error, "carom: " + bad + ": bodies[0].shapes[0].radius: -1 is not positive\n");
    }
}

TEST(CommandLine, bad_arguments) {
    const TestFolder folder;
    const std::string scene = folder.write("scene.json", falling_2);
    for (const std::string& arguments :
         {std::string(), std::string("frobnicate"), std::string("run"), "run " + scene + " --steps -1",
          "run " + scene + " --steps many", "run " + scene + " --steps 1.5", "run " + scene + " --threads 0",
          "run " + scene + " --frames 3", "run " + scene + " " + scene, "run " + scene + " --trace",
          std::string("bench nothing"), std::string("bench --repeat 0"),
          std::string("bench large_pyramid_2 --steps 1"), std::string("validate A99"),
          std::string("help frobnicate"), std::string("check"), std::string("--frob")}) {
        const Outcome outcome = carom(folder, arguments);
        EXPECT_EQ(outcome.status, 2) << arguments;
        EXPECT_EQ(outcome.error.substr(0, 7), "carom: ") << arguments;
        EXPECT_EQ(outcome.out, "") << arguments;
    }
}

TEST(CommandLine, check) {
    const TestFolder folder;
    const Outcome good = carom(folder, "check " + folder.write("scene.json", falling_2));
    EXPECT_EQ(good.status, 0);
    EXPECT_NE(good.out.find("nothing suspicious"), std::string::npos);
    const std::string bad = folder.write("bad.json", body_text(2, R"("type": "fixed", "velocity": [1, 0])"));
    const Outcome suspicious = carom(folder, "check " + bad);
    EXPECT_EQ(suspicious.status, 1);
    EXPECT_EQ(lines_of(suspicious.out).at(0), bad + ": bodies[0].velocity: has no effect on a fixed body");
}

TEST(CommandLine, bench) {
    const TestFolder folder;
    const auto names = lines_of(carom(folder, "bench --list").out);
    for (const std::string name : {"large_pyramid_2", "many_pyramids_2", "smash_2", "sleeping_city_2",
                                   "sleeping_city_3", "large_pyramid_3", "many_pyramids_3", "convex_pile_3",
                                   "convex_vs_mesh_3", "large_world_3", "wide_pyramid_3", "pyramid_3"})
        EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;

    const Outcome run = carom(folder, "bench wide_pyramid_3 --threads 1,2 --steps 3 --repeat 2 --json");
    ASSERT_EQ(run.status, 0) << run.error;
    EXPECT_EQ(keys_of(run.out),
              (std::vector<std::string>{"name", "dimension", "bodies", "contacts", "joints", "steps",
                                        "threads", "ms_per_step", "ms_per_step_best", "hash"}));
    const json rows = json::parse(run.out);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0]["bodies"], 1241);
    EXPECT_EQ(rows[0]["steps"], 3);
    EXPECT_EQ(rows[1]["threads"], 2);
    EXPECT_EQ(rows[0]["hash"], rows[1]["hash"]);
    EXPECT_LE(rows[0]["ms_per_step_best"], rows[0]["ms_per_step"]);
}

TEST(CommandLine, validate) {
    const TestFolder folder;
    const Outcome run = carom(folder, "validate A1 --json");
    ASSERT_EQ(run.status, 0) << run.error;
    EXPECT_EQ(keys_of(run.out), (std::vector<std::string>{"name", "what", "reference", "result", "error",
                                                          "hard", "gold", "status"}));
    for (const json& row : json::parse(run.out)) {
        EXPECT_EQ(row["name"], "A1");
        EXPECT_NE(row["status"], "fail");
    }
    EXPECT_NE(carom(folder, "validate A1").out.find("0 failed"), std::string::npos);
}

TEST(CommandLine, help_and_version) {
    const TestFolder folder;
    EXPECT_EQ(carom(folder, "--version").out, "carom 0.1.0\n");
    for (const std::string arguments :
         {"help", "--help", "help run", "run --help", "help help", "bench --help"}) {
        const Outcome outcome = carom(folder, arguments);
        EXPECT_EQ(outcome.status, 0) << arguments;
        EXPECT_NE(outcome.out.find("Usage: carom"), std::string::npos) << arguments;
    }
    const std::string all = carom(folder, "help").out;
    for (const std::string command : {"run", "validate", "check", "bench", "help"})
        EXPECT_NE(all.find("\n  " + command + " "), std::string::npos) << command;
    EXPECT_NE(carom(folder, "help run").out.find("--trace-bodies"), std::string::npos);
}

}  // namespace
}  // namespace carom::io
