#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

// `carom validate --html`: a page that needs nothing beside itself.

namespace {

struct Page {
    std::string text;
    int status = -1;
};

Page page_of(const std::string& cases) {
    // Tests run side by side, and each writes a page of its own.
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / ("carom_validation_page_" + name + ".html");
    std::filesystem::remove(path);
    const std::string command = std::string("'") + CAROM_PROGRAM + "' validate " + cases + " --html '" +
                                path.string() + "' > /dev/null";
    Page page;
    page.status = std::system(command.c_str());
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    page.text = text.str();
    std::filesystem::remove(path);
    return page;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

TEST(ValidationPage, HoldsResultsAndFigures) {
    const Page page = page_of("A1 A3");
    EXPECT_EQ(page.status, 0);
    EXPECT_EQ(count(page.text, "<h2 "), 2u);
    EXPECT_NE(page.text.find("3D, Verlet, h = 1/240: height at 1 s (m)"), std::string::npos);
    EXPECT_NE(page.text.find("5.09"), std::string::npos);
    // A figure a case, and a bar a result.
    EXPECT_EQ(count(page.text, "aria-label='error and bounds'"), 16u + 16u);
    EXPECT_EQ(count(page.text, "<svg xmlns"), 2u);
    EXPECT_EQ(count(page.text, "<svg"), count(page.text, "</svg>"));
    EXPECT_EQ(count(page.text, "nan"), 0u);
}

TEST(ValidationPage, OrdersOfMethodsAreMeasured) {
    const std::string text = page_of("A3").text;
    const auto order = [&](const std::string& method) {
        std::smatch found;
        const std::regex pattern(method + ", order ([0-9.]+)");
        return std::regex_search(text, found, pattern) ? std::stod(found[1]) : -1;
    };
    EXPECT_NEAR(order("semi-implicit Euler"), 1, 0.1);
    EXPECT_NEAR(order("Verlet"), 2, 0.1);
    EXPECT_NEAR(order("RK4"), 4, 0.2);
}

TEST(ValidationPage, NeedsNoNetwork) {
    const std::string text = page_of("A1").text;
    ASSERT_FALSE(text.empty());
    EXPECT_EQ(count(text, "http"), count(text, "http://www.w3.org/2000/svg")) << "the name of a name space";
    EXPECT_EQ(count(text, "src="), 0u);
    EXPECT_EQ(count(text, "@import"), 0u);
}

TEST(ValidationPage, IsRefusedWhereItCannotBeWritten) {
    const std::string command =
        std::string("'") + CAROM_PROGRAM + "' validate A1 --html /no/such/folder/page.html > /dev/null 2>&1";
    EXPECT_NE(std::system(command.c_str()), 0);
}

}  // namespace
