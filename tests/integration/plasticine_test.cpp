// tests/integration/plasticine_test.cpp -- a simulated hand kneads plasticine, through real
// processes.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "idl/scene.h"
#include "node/dds/reader.h"
#include "tests/integration/live_session.h"
#include "tests/support/filled.h"

namespace cordis::test {
namespace {

const std::string kConfigs = CORDIS_SOURCE_DIR "/launch_configs/";

/// The values of a signal as they go by, without repetitions.
class SignalHistory {
 public:
  SignalHistory(dds::Participant& participant, std::string name)
      : name_(std::move(name)),
        descriptions_(participant, dds::Topic::kDescription),
        signals_(participant, dds::Topic::kSignals) {}

  const std::vector<double>& update() {
    while (descriptions_.take(description_)) {
    }
    const auto& all = description_.signals();
    const auto found = std::find_if(all.begin(), all.end(),
                                    [this](const auto& signal) { return signal.name() == name_; });
    const auto column = static_cast<std::size_t>(found - all.begin());
    msg::SceneSignals batch;
    while (found != all.end() && signals_.take(batch)) {
      for (std::size_t i = column; i < batch.value().size(); i += batch.signal_count()) {
        const double value = batch.value()[i];
        if (history_.empty() || history_.back() != value) history_.push_back(value);
      }
    }
    return history_;
  }

 private:
  std::string name_;
  dds::Reader<msg::SceneDescription> descriptions_;
  dds::Reader<msg::SceneSignals> signals_;
  msg::SceneDescription description_;
  std::vector<double> history_;
};

TEST(Plasticine, IsTornInTwoAndIsOneAgainInTheHandsOfTwoProcesses) {
  LiveSession session(
      "lockstep",
      filled(R"(  sim: {node: sim_node, scene: '<configs>scenes/plasticine.yaml', duration_s: 2.7}
  thimbles: {node: device_node, device: '<configs>devices/two_thimbles.yaml', driver: mock,
             mock: {hand: {gesture: {kind: knead, open_m: 0.015, grip_m: -0.06, in_s: 0.7, stay_s: 0.3}}}}
)",
             {{"configs", kConfigs}}));
  SignalHistory pieces(session.participant(), "pieces");
  session.start("sim_node", "sim");
  session.start("device_node", "thimbles");

  const std::vector<double> expected{1.0, 2.0, 1.0};
  EXPECT_TRUE(eventually([&] { return pieces.update() == expected; }));
  EXPECT_EQ(session.node("sim").wait(kPatience), 0);
  EXPECT_EQ(pieces.update(), expected);
}

}  // namespace
}  // namespace cordis::test
