// session.c
#include "session.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "control.h"

enum { LARGEST_DOMAIN = 101, MAX_PEERS = 64 };

static const int64_t kPollPeriodNsec = 20000000;  // for a scene
static const int64_t kSilenceNsec = 5000000000;   // that is reported

static volatile sig_atomic_t stop = 0;

static dds_entity_t checked(dds_entity_t entity, const char* what) {
  if (entity >= 0) return entity;
  fprintf(stderr, "error: DDS has no %s: %s\n", what, dds_strretcode(-entity));
  exit(1);
}

struct session join(const char* domain, const char* name) {
  char* end = NULL;
  const long number = strtol(domain, &end, 10);
  if (end == domain || *end != '\0' || number < 0 || number > LARGEST_DOMAIN) {
    fprintf(stderr, "error: '%s' is no DDS domain, 0 to %d: `cordis list` names it\n", domain,
            LARGEST_DOMAIN);
    exit(2);
  }
  if (getenv("CYCLONEDDS_URI") == NULL) {
    fprintf(stderr,
            "error: set CYCLONEDDS_URI=file:///PATH/OF/idl/cyclonedds.xml: "
            "a session is found on 127.0.0.1 alone\n");
    exit(2);
  }
  struct session session = {.name = name};
  session.participant =
      checked(dds_create_participant((dds_domainid_t)number, NULL, NULL), "participant");
  dds_qos_t* qos = dds_create_qos();
  dds_qset_partition1(qos, name);  // the session
  session.publisher = checked(dds_create_publisher(session.participant, qos, NULL), "publisher");
  session.subscriber = checked(dds_create_subscriber(session.participant, qos, NULL), "subscriber");
  dds_delete_qos(qos);
  return session;
}

static dds_qos_t* create_qos(enum qos kind) {
  dds_qos_t* qos = dds_create_qos();
  const bool reliable = kind != QOS_GESTURE_REALTIME;
  dds_qset_reliability(qos, reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_MSECS(100));
  dds_qset_durability(qos,
                      kind == QOS_TRANSIENT_LOCAL ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  static const int32_t depth[] = {
      [QOS_TRANSIENT_LOCAL] = 1, [QOS_STREAM] = 256, [QOS_GESTURE_REALTIME] = 1, [QOS_GESTURE_LOCKSTEP] = 8};
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth[kind]);
  return qos;
}

static dds_entity_t create_topic(const struct session* session, const dds_topic_descriptor_t* type,
                                 const char* name) {
  return checked(dds_create_topic(session->participant, type, name, NULL, NULL), "topic");
}

dds_entity_t create_reader(const struct session* session, const dds_topic_descriptor_t* type,
                           const char* topic_name, enum qos kind) {
  const dds_entity_t topic = create_topic(session, type, topic_name);
  dds_qos_t* qos = create_qos(kind);
  const dds_entity_t reader =
      checked(dds_create_reader(session->subscriber, topic, qos, NULL), "reader");
  dds_delete_qos(qos);
  return reader;
}

dds_entity_t create_writer(const struct session* session, const dds_topic_descriptor_t* type,
                           const char* topic_name, enum qos kind) {
  const dds_entity_t topic = create_topic(session, type, topic_name);
  dds_qos_t* qos = create_qos(kind);
  const dds_entity_t writer =
      checked(dds_create_writer(session->publisher, topic, qos, NULL), "writer");
  dds_delete_qos(qos);
  return writer;
}

bool take(dds_entity_t reader, void* message) {
  dds_sample_info_t info;
  while (dds_take(reader, &message, &info, 1, 1) == 1) {
    if (info.valid_data) return true;  // else it says that a writer has left
  }
  return false;
}

void publish(dds_entity_t writer, const void* message) {
  checked(dds_write(writer, message), "room for a message");
}

dds_entity_t create_waitset(const struct session* session, dds_entity_t reader) {
  const dds_entity_t set = checked(dds_create_waitset(session->participant), "wait set");
  const dds_entity_t any = checked(dds_create_readcondition(reader, DDS_ANY_STATE), "condition");
  dds_waitset_attach(set, any, 0);
  return set;
}

void wait_for_message(dds_entity_t waitset, int64_t at_most_nsec) {
  if (at_most_nsec > 0) dds_waitset_wait(waitset, NULL, 0, at_most_nsec);
}

/// The version in the user data of a participant of Cordis, "process ... wire N"; 0: it has none.
static uint32_t wire_version_of(const dds_qos_t* qos) {
  void* data = NULL;
  size_t size = 0;
  uint32_t version = 0;
  if (dds_qget_userdata(qos, &data, &size) && data != NULL) {
    const char* mark = strstr(data, " wire ");  // Cyclone ends the data with a zero
    if (strncmp(data, "process ", 8) == 0 && mark != NULL)
      version = (uint32_t)strtoul(mark + 6, NULL, 10);
    dds_free(data);
  }
  return version;
}

/// True if a participant is a process of the session: its name is "SESSION/NODE".
static bool is_of_session(const dds_qos_t* qos, const char* session) {
  char* name = NULL;
  const size_t length = strlen(session);
  if (!dds_qget_entity_name(qos, &name) || name == NULL) return false;
  const bool fits = strncmp(name, session, length) == 0 && name[length] == '/';
  dds_free(name);
  return fits;
}

static void check_wire_version(uint32_t version) {
  if (version == cordis_msg_WIRE_VERSION) return;
  fprintf(stderr,
          "error: the session speaks version %u of the messages, this program version %u:"
          " compile it against the idl/ of that Cordis\n",
          version, (unsigned)cordis_msg_WIRE_VERSION);
  exit(1);
}

void check_wire_versions(const struct session* session) {
  const dds_entity_t reader = checked(
      dds_create_reader(session->participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, NULL, NULL),
      "reader of participants");
  void* found[MAX_PEERS] = {NULL};
  dds_sample_info_t info[MAX_PEERS];
  const int count = dds_read(reader, found, info, MAX_PEERS, MAX_PEERS);
  for (int i = 0; i < count; ++i) {
    if (!info[i].valid_data) continue;
    const dds_builtintopic_participant_t* peer = found[i];
    const uint32_t version = wire_version_of(peer->qos);
    if (version != 0 && is_of_session(peer->qos, session->name)) check_wire_version(version);
  }
  if (count > 0) dds_return_loan(reader, found, count);
  dds_delete(reader);
}

bool take_scene(dds_entity_t scenes, cordis_msg_SceneDescription* scene) {
  // A sim_node that leaves makes an empty message: the last scene stays.
  cordis_msg_SceneDescription next = {0};
  bool is_new = false;
  while (take(scenes, &next)) {
    const cordis_msg_SceneDescription before = *scene;
    *scene = next;
    next = before;
    is_new = true;
  }
  dds_sample_free(&next, &cordis_msg_SceneDescription_desc, DDS_FREE_CONTENTS);
  if (is_new) check_wire_version(scene->wire_version);
  return is_new;
}

void await_scene(const struct session* session, dds_entity_t scenes,
                 cordis_msg_SceneDescription* scene) {
  const int64_t begin_nsec = now_nsec();
  bool is_reported = false;
  while (!stop_requested()) {
    check_wire_versions(session);  // first: a message of another version may not even be readable
    if (take_scene(scenes, scene)) return;
    if (!is_reported && now_nsec() - begin_nsec > kSilenceNsec) {
      fprintf(stderr,
              "warning: no scene for 5 s: `cordis list` shows domain and name of every "
              "session of this host\n");
      is_reported = true;
    }
    sleep_until(now_nsec() + kPollPeriodNsec);
  }
}

uint32_t id_of(const char* name) {
  uint32_t hash = 2166136261u;
  for (; *name != '\0'; ++name) hash = (hash ^ (unsigned char)*name) * 16777619u;
  return hash;
}

int64_t now_nsec(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

void sleep_until(int64_t time_nsec) {
  const struct timespec time = {time_nsec / 1000000000, time_nsec % 1000000000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, NULL);
}

static void request_stop(int number) {
  (void)number;
  stop = 1;
}

void catch_stop_signals(void) {
  signal(SIGINT, request_stop);
  signal(SIGTERM, request_stop);
}

bool stop_requested(void) {
  return stop != 0;
}
