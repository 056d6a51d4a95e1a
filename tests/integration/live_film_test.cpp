// tests/integration/live_film_test.cpp -- a film of a session that ends before it.
#include <csignal>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/support/child_process.h"
#include "tests/support/eventually.h"
#include "tests/support/test_domain.h"

namespace cordis::test {
namespace {

TEST(LiveFilm, SaysOnceThatTheSessionEndedBeforeItsDuration) {
  const std::string name = "filmed-" + std::to_string(getpid());
  LiveSession session("realtime", kSimAndKey, name);
  session.add_file("scene.yaml", wall_scene(200.0));
  session.add_file("key.yaml", steady_key(0, 0));
  session.start("device_node", "keyboard");
  ChildProcess& simulation = session.start("sim_node", "sim");
  const std::filesystem::path images = session.folder() / "images";
  ChildProcess film({program_path("cordis"), "film", name, "--domain", std::to_string(own_domain()),
                     "--duration", "3600s", "--size", "160x90", "-o", images.string() + "/"});
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(images / "frame_00002.png"); }))
      << film.output();

  simulation.signal(SIGINT);

  EXPECT_EQ(film.wait(kPatience), 1);
  const std::string said = film.output();
  EXPECT_NE(said.find("the scene ended after "), std::string::npos) << said;
  EXPECT_NE(said.find(" images of "), std::string::npos) << said;
  const std::size_t first = said.find("sends nothing any more");
  EXPECT_NE(first, std::string::npos) << said;
  EXPECT_EQ(said.rfind("sends nothing any more"), first) << said;
}

}  // namespace
}  // namespace cordis::test
