// command.c -- sends a command to a node of a session and prints its reply.
// usage: foreign_command DOMAIN SESSION TARGET VERB [ARGUMENT]    (docs/control.md)
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "control.h"
#include "session.h"
#include "topics.h"

static const int64_t kRepeatAfterNsec = 300000000;  // of a command without a reply
static const int64_t kPatienceNsec = 10000000000;   // for the reply

static const char* const kVerbs[] = {"pause", "resume", "step", "reset", "load",
                                     "set",   "state",  "get",  "seek",  "rate"};

/// The number of a verb, in the order of ControlVerb; -1: no such verb.
static int verb_named(const char* word) {
  const int count = (int)(sizeof kVerbs / sizeof kVerbs[0]);
  for (int verb = 0; verb < count; ++verb) {
    if (strcmp(word, kVerbs[verb]) == 0) return verb;
  }
  return -1;
}

int main(int argc, char** argv) {
  const int verb = argc >= 5 ? verb_named(argv[4]) : -1;
  if (verb < 0 || argc > 6) {
    fprintf(stderr, "usage: foreign_command DOMAIN SESSION TARGET VERB [ARGUMENT]\nverbs:");
    for (size_t v = 0; v < sizeof kVerbs / sizeof kVerbs[0]; ++v) fprintf(stderr, " %s", kVerbs[v]);
    fprintf(stderr, "\n");
    return 2;
  }
  const struct session session = join(argv[1], argv[2]);
  const dds_entity_t replies =
      create_reader(&session, &cordis_msg_ControlReply_desc, cordis_msg_TOPIC_REPLY, QOS_STREAM);
  const dds_entity_t commands = create_writer(&session, &cordis_msg_ControlCommand_desc,
                                              cordis_msg_TOPIC_COMMAND, QOS_STREAM);
  const dds_entity_t waitset = create_waitset(&session, replies);
  char sender[32];
  snprintf(sender, sizeof sender, "foreign-%ld", (long)getpid());
  const cordis_msg_ControlCommand command = {.command_id = (uint64_t)now_nsec(),
                                             .sender = sender,
                                             .target = argv[3],
                                             .verb = (cordis_msg_ControlVerb)verb,
                                             .argument = argc == 6 ? argv[5] : ""};

  // A node may join later than the command is written. It executes a number once, however often the
  // command comes.
  const int64_t begin_nsec = now_nsec();
  while (now_nsec() - begin_nsec < kPatienceNsec) {
    check_wire_versions(&session);
    publish(commands, &command);
    wait_for_message(waitset, kRepeatAfterNsec);
    cordis_msg_ControlReply reply = {0};
    while (take(replies, &reply)) {
      if (reply.command_id != command.command_id || strcmp(reply.sender, sender) != 0) continue;
      printf("%s %s: %s\n", reply.node, reply.accepted ? "accepted" : "refused", reply.text);
      return reply.accepted ? 0 : 1;
    }
  }
  fprintf(stderr, "error: no reply for 10 s: is '%s' a node of session '%s' in domain %s?\n",
          argv[3], argv[2], argv[1]);
  return 1;
}
