// session.h -- what every program in a session of Cordis does: idl/README.md, "Programs of others".
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "dds/dds.h"
#include "scene.h"

/// Quality of service of a topic: the table in idl/README.md.
enum qos {
  QOS_TRANSIENT_LOCAL,   ///< reliable, the newest of each key kept for late joiners
  QOS_STREAM,            ///< reliable, every message counts
  QOS_GESTURE_REALTIME,  ///< best effort, the newest alone
  QOS_GESTURE_LOCKSTEP   ///< reliable, every message counts
};

struct session {
  const char* name;
  dds_entity_t participant;
  dds_entity_t publisher;
  dds_entity_t subscriber;
};

/// Joins a session. Ends the program with code 2 when `domain` is no domain or CYCLONEDDS_URI is not
/// set, and with code 1 when DDS does not work.
struct session join(const char* domain, const char* name);

/// Waits for the scene of the session, or for a signal. Ends the program with code 1 when the session
/// speaks another version of the messages. Says after 5 s that it waits.
void await_scene(const struct session* session, dds_entity_t scenes,
                 cordis_msg_SceneDescription* scene);

/// Takes the newest scene; true when there is another one than before. Ends the program with code 1
/// when the scene is of another version of the messages.
bool take_scene(dds_entity_t scenes, cordis_msg_SceneDescription* scene);

/// Ends the program with code 1 when a process of the session speaks another version of the messages.
void check_wire_versions(const struct session* session);

dds_entity_t create_reader(const struct session* session, const dds_topic_descriptor_t* type,
                           const char* topic, enum qos qos);
dds_entity_t create_writer(const struct session* session, const dds_topic_descriptor_t* type,
                           const char* topic, enum qos qos);

/// Takes the next message. Returns false when none has come: then `message` may be empty.
bool take(dds_entity_t reader, void* message);

/// Writes a message; ends the program with code 1 when DDS does not take it.
void publish(dds_entity_t writer, const void* message);

/// What wait_for_message() waits on: the messages of a reader.
dds_entity_t create_waitset(const struct session* session, dds_entity_t reader);

/// Waits until the reader of a wait set has a message, at most so long.
void wait_for_message(dds_entity_t waitset, int64_t at_most_nsec);

/// FNV-1a hash of a name, 32 bits: the id of a device or a node.
uint32_t id_of(const char* name);

/// CLOCK_MONOTONIC [ns]: the clock of every time in a message.
int64_t now_nsec(void);

/// Sleeps until CLOCK_MONOTONIC has this time.
void sleep_until(int64_t time_nsec);

/// Begins to note SIGINT and SIGTERM.
void catch_stop_signals(void);
bool stop_requested(void);
