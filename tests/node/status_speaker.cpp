// tests/node/status_speaker.cpp -- a process of a session that publishes its status and has readers
// of other topics, as a child of a test. usage: status_speaker DOMAIN SESSION NODE. Any signal that ends a process ends it.
#include <cstdlib>

#include <unistd.h>

#include "idl/control.h"
#include "idl/scene.h"
#include "node/dds/reader.h"
#include "node/status.h"
#include "node/time.h"

int main(int argc, char** argv) {
  using namespace cordis;
  if (argc != 4) return 2;
  dds::Participant participant({std::atoi(argv[1]), argv[2], argv[3]});
  const node::StatusPublisher status(participant, msg::KIND_DEVICE_NODE,
                                     static_cast<std::uint64_t>(node::monotonic_nsec()),
                                     [](msg::NodeStatus& said) { said.phase(msg::PHASE_RUNNING); });
  const dds::Reader<msg::NodeStatus> statuses(participant, dds::Topic::kStatus);
  const dds::Reader<msg::ControlReply> replies(participant, dds::Topic::kReply);
  const dds::Reader<msg::SceneEvents> events(participant, dds::Topic::kEvents);
  for (;;) pause();
}
