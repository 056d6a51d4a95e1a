// tests/viz/static_pages_test.cpp
#include "viz_node/web/static_pages.h"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

namespace cordis::viz {
namespace {

namespace fs = std::filesystem;

class StaticPagesTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "cordis-pages-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    root = name;
    fs::create_directory(root / "page");
    write(root / "secret.txt", "secret");
  }
  void TearDown() override { fs::remove_all(root); }

  static void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

  fs::path root;
};

TEST_F(StaticPagesTest, ServesTheFilesOfItsFolderWithTheirTypes) {
  write(root / "page" / "index.html", "<p>");
  write(root / "page" / "page.js", "1");
  const StaticPages pages(root / "page");

  EXPECT_TRUE(pages.built());
  ASSERT_NE(pages.find("/"), nullptr);
  EXPECT_EQ(pages.find("/")->content, "<p>");
  EXPECT_EQ(pages.find("/")->type, "text/html; charset=utf-8");
  ASSERT_NE(pages.find("/page.js"), nullptr);
  EXPECT_EQ(pages.find("/page.js")->type, "text/javascript; charset=utf-8");
}

TEST_F(StaticPagesTest, GivesTheShortestFormThatABrowserTakes) {
  for (const char* name : {"index.html", "page.js"}) {
    write(root / "page" / name, "plain");
    write(root / "page" / (std::string(name) + ".gz"), "gzipped");
  }
  write(root / "page" / "page.js.br", "brotli");
  const StaticPages pages(root / "page");
  const auto content = [&pages](const char* path, const char* accepted) {
    const StaticPage* const page = pages.find(path, accepted);
    return page == nullptr ? "none" : page->content + "," + page->encoding + "," + page->type;
  };
  const std::string js = "text/javascript; charset=utf-8";

  EXPECT_EQ(content("/page.js", ""), "plain,," + js);
  EXPECT_EQ(content("/page.js", "gzip, deflate, br"), "brotli,br," + js);
  EXPECT_EQ(content("/page.js", "deflate,gzip;q=0.5"), "gzipped,gzip," + js);
  EXPECT_EQ(content("/page.js", "br;q=0, gzip"), "gzipped,gzip," + js);
  EXPECT_EQ(content("/page.js", "brotli, x-gzip"), "plain,," + js);
  EXPECT_EQ(content("/", "br, gzip"), "gzipped,gzip,text/html; charset=utf-8");
  EXPECT_EQ(content("/page.js.br", "br"), "none") << "it is no page of its own";
}

TEST_F(StaticPagesTest, FindsNothingOutsideItsFolder) {
  write(root / "page" / "index.html", "<p>");
  const StaticPages pages(root / "page");

  for (const char* path : {"/../secret.txt", "/./index.html", "/page/../../secret.txt",
                           "//index.html", "index.html", "", "/secret.txt"}) {
    EXPECT_EQ(pages.find(path), nullptr) << path;
  }
}

TEST_F(StaticPagesTest, SaysHowToBuildThePageWhereThereIsNone) {
  for (const fs::path& folder : {root / "page", root / "nowhere"}) {
    const StaticPages pages(folder);
    EXPECT_FALSE(pages.built());
    ASSERT_NE(pages.find("/"), nullptr);
    EXPECT_NE(pages.find("/")->content.find("page not built: run `npm ci`"), std::string::npos);
  }
}

}  // namespace
}  // namespace cordis::viz
