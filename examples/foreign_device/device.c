// device.c -- a device of one axis in a session of Cordis, in the role that the scene gives it.
// usage: foreign_device DOMAIN SESSION DEVICE [--lockstep]
//
// The device is simulated at the end of this file: a vendor replaces those four functions and the
// figures in describe().
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "control.h"
#include "gesture.h"
#include "scene.h"
#include "session.h"
#include "topics.h"

#define RATE_HZ 1000.0
#define LOWEST_M (-0.04)
#define HIGHEST_M 0.0
#define FORCE_LIMIT_N 10.0
#define SLEW_N_PER_S 5000.0
#define SPEED_LIMIT_M_PER_S 1.0
#define WATCHDOG_S 0.02  // an answer is worth nothing at this age

static const int64_t kPeriodNsec = 1000000;
static const int64_t kPollPeriodNsec = 10000000;    // at signals and scenes, while it waits
static const int64_t kRepeatAfterNsec = 100000000;  // of a sample without an answer, in lockstep
static const int64_t kCheckAfterNsec = 1000000000;  // of the versions, without answers
static const int64_t kSilenceNsec = 5000000000;     // that is reported

static double key_position_m(uint64_t tick);  // up is positive
static double hand_force_n(uint64_t tick);    // of the hand on the key, up is positive
static void drive_with_force(double force_n);
static void drive_to_position(double position_m);

/// Positions or forces: the messages begin alike, up to and with the values of the axes.
union gesture {
  cordis_msg_GesturePositions positions;
  cordis_msg_GestureForces forces;
};

struct device {
  struct session session;
  const char* name;
  uint32_t id;
  bool lockstep;
  dds_entity_t scenes;
  cordis_msg_SceneDescription scene;  // the newest

  cordis_msg_PortRole role;  // that is played
  dds_entity_t writer;
  dds_entity_t reader;
  dds_entity_t waitset;  // of the reader
  union gesture sample;  // sent last
  union gesture answer;  // the newest; answered_sample 0: none
  bool has_lost_answers;
  double force_n;        // role mass: on the motor
  double largest_n;      // that it has been
  double max_rise_n;     // of its magnitude in a period
  double position_m;     // role liaison: where the motor has led the key
  double work_j;         // role liaison: that the hand has given
  double work_from_m;    // role liaison: where its work was counted last
  double delay_s;        // realtime: age of a sample when its answer went to the motor
  uint64_t answered;     // samples of this part
  int64_t part_nsec;     // when the part began; 0: its silence has been reported
  int64_t checked_nsec;  // when the versions were compared
};

/// Publishes what the device is. A device without a description gets no force: its limits are
/// unknown.
static void describe(const struct device* device) {
  const cordis_msg_DeviceDescription description = {
      .device_id = device->id,
      .wire_version = cordis_msg_WIRE_VERSION,
      .device = (char*)device->name,
      .driver = "foreign_device",
      .epoch = device->sample.forces.epoch,
      .coordinate_count = 1,
      .rate_hz = RATE_HZ,
      .lowest_m = LOWEST_M,
      .highest_m = HIGHEST_M,
      .force_limit_n = FORCE_LIMIT_N,
      .moving_mass_kg = 0.05,
      .viscosity_n_s_per_m = 1.0,
      .travel_m = {HIGHEST_M - LOWEST_M},
      .force_n = {FORCE_LIMIT_N},
      .plays_mass = true,
      .plays_liaison = true,
  };
  publish(create_writer(&device->session, &cordis_msg_DeviceDescription_desc,
                        cordis_msg_TOPIC_DEVICE, QOS_TRANSIENT_LOCAL),
          &description);
}

/// Finds the port of the device in the newest scene; NULL when it has none that the device can play.
static const cordis_msg_PortDescription* find_port(const struct device* device) {
  for (uint32_t p = 0; p < device->scene.ports._length; ++p) {
    const cordis_msg_PortDescription* port = &device->scene.ports._buffer[p];
    if (port->device_id != device->id) continue;
    if (port->axes._length == 1 && port->axes._buffer[0] == 0) return port;
    fprintf(stderr, "error: port '%s' wants other axes than axis 0 of '%s'\n", port->name,
            device->name);
  }
  return NULL;
}

/// True while the device goes on with its role.
static bool goes_on(struct device* device) {
  if (stop_requested()) return false;
  if (!take_scene(device->scenes, &device->scene)) return true;
  const cordis_msg_PortDescription* port = find_port(device);
  return port != NULL && port->role == device->role;
}

/// Reads the sensor and sends the next sample.
static void send_sample(struct device* device, uint64_t tick) {
  cordis_msg_GestureForces* sample = &device->sample.forces;
  const cordis_msg_GestureForces* answer = &device->answer.forces;
  ++sample->sample;  // goes on through all roles and scenes of the process
  sample->answered_epoch = answer->epoch;
  sample->answered_sample = answer->sample;
  sample->answered_time_nsec = answer->time_nsec;
  if (device->role == cordis_msg_ROLE_MASS) {
    device->sample.positions.position_m[0] = key_position_m(tick);
    device->sample.positions.answer_delay_s = device->delay_s;
  } else {
    const double force_before_n = sample->force_n[0];
    sample->force_n[0] = hand_force_n(tick);
    device->work_j +=
        0.5 * (force_before_n + sample->force_n[0]) * (device->position_m - device->work_from_m);
    device->work_from_m = device->position_m;
    sample->work_j = device->work_j;
    sample->answer_delay_s = device->delay_s;
  }
  sample->time_nsec = now_nsec();
  publish(device->writer, &device->sample);
}

/// Takes the answers that are there; true when the newest sample has its answer. Any program of the
/// session may write an answer, so no number of it is trusted.
static bool receive(struct device* device) {
  const cordis_msg_GestureForces* sample = &device->sample.forces;
  union gesture message;
  while (take(device->reader, &message)) {
    const cordis_msg_GestureForces* answer = &message.forces;
    const bool is_ours = answer->device_id == device->id && answer->answered_epoch == sample->epoch;
    const bool is_sound = answer->axis_count >= 1 && answer->axis_count <= cordis_msg_MAX_AXES &&
                          answer->answered_sample <= sample->sample &&
                          answer->answered_time_nsec >= 0 &&
                          answer->answered_time_nsec <= sample->time_nsec;
    const bool is_newer = answer->answered_sample > device->answer.forces.answered_sample;
    if (!is_ours || !is_sound || !is_newer) continue;
    device->answer = message;
    ++device->answered;
  }
  return device->answer.forces.answered_sample == sample->sample;
}

static double clamp(double value, double lowest, double highest) {
  return value < lowest ? lowest : value > highest ? highest : value;
}

/// Hands the newest answer to the motor, once a period. @param age_s  of the sample that it answers
static void act(struct device* device, double age_s) {
  const double value = device->answer.forces.force_n[0];  // a position in role liaison
  const bool is_lost = !(age_s >= 0.0 && age_s < WATCHDOG_S) || !isfinite(value);
  if (is_lost != device->has_lost_answers)
    printf(is_lost ? "no answer for 20 ms: no force\n" : "answers come\n");
  device->has_lost_answers = is_lost;
  if (is_lost) {
    device->force_n = 0.0;
    drive_with_force(0.0);
  } else if (device->role == cordis_msg_ROLE_MASS) {
    // The force fades so as to be 0 when the watchdog bites.
    const double limit_n = fmin(FORCE_LIMIT_N, SLEW_N_PER_S * (WATCHDOG_S - age_s));
    const double change_n = SLEW_N_PER_S / RATE_HZ;
    const double wanted_n = clamp(value, device->force_n - change_n, device->force_n + change_n);
    const double before_n = device->force_n;
    device->force_n = clamp(wanted_n, -limit_n, limit_n);
    device->max_rise_n = fmax(device->max_rise_n, fabs(device->force_n) - fabs(before_n));
    device->largest_n = fmax(device->largest_n, fabs(device->force_n));
    drive_with_force(device->force_n);
  } else {
    const double change_m = SPEED_LIMIT_M_PER_S / RATE_HZ;
    const double wanted_m = clamp(value, LOWEST_M, HIGHEST_M);
    device->position_m =
        clamp(wanted_m, device->position_m - change_m, device->position_m + change_m);
    drive_to_position(device->position_m);
  }
}

/// Says why no answer has come yet. Ends the program when none can come.
static void explain_silence(struct device* device) {
  if (device->has_lost_answers && now_nsec() - device->checked_nsec > kCheckAfterNsec) {
    device->checked_nsec = now_nsec();
    check_wire_versions(&device->session);  // of a sim_node that has come since
  }
  if (device->answered > 0 || device->part_nsec == 0) return;
  dds_offered_incompatible_qos_status_t offered;
  dds_requested_incompatible_qos_status_t requested;
  dds_get_offered_incompatible_qos_status(device->writer, &offered);
  dds_get_requested_incompatible_qos_status(device->reader, &requested);
  const bool is_of_clock =
      (offered.total_count > 0 && offered.last_policy_id == DDS_RELIABILITY_QOS_POLICY_ID) ||
      (requested.total_count > 0 && requested.last_policy_id == DDS_RELIABILITY_QOS_POLICY_ID);
  if (offered.total_count + requested.total_count > 0 && !is_of_clock) {
    fprintf(stderr,
            "error: the session has a hot standby (standby_for in its launch file), which this "
            "example does not support\n");
    exit(1);
  }
  if (is_of_clock) {
    fprintf(stderr, "error: the session runs in %s: start this device %s --lockstep\n",
            device->lockstep ? "realtime" : "lockstep", device->lockstep ? "without" : "with");
    exit(1);
  }
  if (now_nsec() - device->part_nsec < kSilenceNsec) return;
  device->part_nsec = 0;
  fprintf(stderr,
          "warning: no answer for 5 s: is sim_node alive (`cordis ctl`), and does another "
          "program play '%s'?\n",
          device->name);
}

/// The device is the clock of its hand: a sample every period, whether answers come or not.
static void play_in_realtime(struct device* device) {
  int64_t next_nsec = now_nsec();
  for (uint64_t tick = 0; goes_on(device); ++tick) {
    send_sample(device, tick);
    const uint64_t answered = device->answered;
    next_nsec += kPeriodNsec;
    while (!receive(device) && now_nsec() < next_nsec)
      wait_for_message(device->waitset, next_nsec - now_nsec());
    const double age_s = 1e-9 * (double)(now_nsec() - device->answer.forces.answered_time_nsec);
    act(device, age_s);
    if (device->answered != answered) device->delay_s = age_s;
    explain_silence(device);
    sleep_until(next_nsec);
    if (now_nsec() - next_nsec > 20 * kPeriodNsec) next_nsec = now_nsec();  // it was stopped
  }
}

/// The device is the clock of the scene: the next sample follows the answer to the last one.
static void play_in_lockstep(struct device* device) {
  for (uint64_t tick = 0; goes_on(device); ++tick) {
    send_sample(device, tick);
    int64_t sent_nsec = now_nsec();
    while (!receive(device)) {
      const int64_t waited_nsec = now_nsec() - sent_nsec;
      if (waited_nsec > kRepeatAfterNsec) {
        publish(device->writer, &device->sample);  // the same one: it may be lost
        sent_nsec = now_nsec();
      }
      // A motor does not know that time is paused.
      if ((double)waited_nsec * 1e-9 > WATCHDOG_S) act(device, WATCHDOG_S);
      explain_silence(device);
      wait_for_message(device->waitset, kPollPeriodNsec);
      if (!goes_on(device)) return;
    }
    act(device, 0.0);
  }
}

static void play(struct device* device, const cordis_msg_PortDescription* port) {
  const bool is_mass = port->role == cordis_msg_ROLE_MASS;
  const enum qos qos = device->lockstep ? QOS_GESTURE_LOCKSTEP : QOS_GESTURE_REALTIME;
  const dds_topic_descriptor_t* types[] = {&cordis_msg_GesturePositions_desc,
                                           &cordis_msg_GestureForces_desc};
  const char* topics[] = {cordis_msg_TOPIC_POSITIONS, cordis_msg_TOPIC_FORCES};
  device->role = port->role;
  device->writer = create_writer(&device->session, types[!is_mass], topics[!is_mass], qos);
  device->reader = create_reader(&device->session, types[is_mass], topics[is_mass], qos);
  device->waitset = create_waitset(&device->session, device->reader);
  memset(&device->answer, 0, sizeof device->answer);
  device->has_lost_answers = true;
  device->answered = 0;
  device->delay_s = 0.0;
  device->part_nsec = now_nsec();
  printf("playing port '%s' of scene '%s' in role %s\n", port->name, device->scene.name,
         is_mass ? "mass" : "liaison");
  (device->lockstep ? play_in_lockstep : play_in_realtime)(device);
  drive_with_force(0.0);
  printf("%llu samples answered, largest force %g N, raised by %g N a period, last position %g m\n",
         (unsigned long long)device->answered, device->largest_n, device->max_rise_n,
         device->position_m);
  dds_delete(device->waitset);
  dds_delete(device->reader);
  dds_delete(device->writer);
}

/// However the program ends, the motor has no force.
static void release_motor(void) {
  drive_with_force(0.0);
}

int main(int argc, char** argv) {
  const bool lockstep = argc == 5 && strcmp(argv[4], "--lockstep") == 0;
  if (argc != 4 && !lockstep) {
    fprintf(stderr, "usage: foreign_device DOMAIN SESSION DEVICE [--lockstep]\n");
    return 2;
  }
  setvbuf(stdout, NULL, _IOLBF, 0);
  catch_stop_signals();
  atexit(release_motor);
  struct device device = {
      .session = join(argv[1], argv[2]),
      .name = argv[3],
      .id = id_of(argv[3]),
      .lockstep = lockstep,
      .sample.forces = {
          .device_id = id_of(argv[3]), .epoch = (uint64_t)now_nsec(), .axis_count = 1}};
  describe(&device);
  device.scenes = create_reader(&device.session, &cordis_msg_SceneDescription_desc,
                                cordis_msg_TOPIC_DESCRIPTION, QOS_TRANSIENT_LOCAL);
  await_scene(&device.session, device.scenes, &device.scene);
  while (!stop_requested()) {
    const cordis_msg_PortDescription* port = find_port(&device);
    if (port != NULL) {
      play(&device, port);
      continue;
    }
    printf("scene '%s' has no port for '%s': waiting for one that has\n", device.scene.name,
           device.name);
    while (!stop_requested() && !take_scene(device.scenes, &device.scene))
      sleep_until(now_nsec() + kPollPeriodNsec);
  }
  return 0;
}

// The simulated device: a hand that presses the key within 0.2 s and holds it.

static double share_of_press(uint64_t tick) {
  const double seconds = (double)tick / RATE_HZ;
  return seconds < 0.2 - 1e-9 ? seconds / 0.2 : 1.0;
}

static double key_position_m(uint64_t tick) {
  return -0.005 * share_of_press(tick);
}

static double hand_force_n(uint64_t tick) {
  return -1.0 * share_of_press(tick);
}

static void drive_with_force(double force_n) {
  (void)force_n;
}

static void drive_to_position(double position_m) {
  (void)position_m;
}
