// listen.c -- prints the signals of a session as a table, or its frames.
// usage: foreign_listen DOMAIN SESSION signals|frames
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "scene.h"
#include "session.h"
#include "topics.h"

static const int64_t kPollPeriodNsec = 100000000;

static void print_header(const cordis_msg_SceneDescription* scene) {
  printf("time [s]");
  for (uint32_t i = 0; i < scene->signals._length; ++i) {
    const cordis_msg_SignalDescription* signal = &scene->signals._buffer[i];
    printf(",%s [%s]", signal->name, signal->unit);
  }
  printf("\n");
}

/// Rows at the gesture rate; the batches of RATE_STEP hold other columns.
static void print_signals(const cordis_msg_SceneSignals* batch, double step_rate_hz) {
  if (batch->rate != cordis_msg_RATE_GESTURE || batch->signal_count == 0) return;
  if (batch->dropped_rows > 0) printf("# %" PRIu32 " rows lost\n", batch->dropped_rows);
  const uint32_t rows = batch->value._length / batch->signal_count;
  for (uint32_t row = 0; row < rows; ++row) {
    const bool is_even = batch->row_step._length <= row;
    const uint64_t step = batch->first_step + (is_even ? (uint64_t)row * batch->stride_steps
                                                       : batch->row_step._buffer[row]);
    printf("%.9g", (double)step / step_rate_hz);
    for (uint32_t i = 0; i < batch->signal_count; ++i)
      printf(",%.17g", batch->value._buffer[row * batch->signal_count + i]);
    printf("\n");
  }
}

static void print_frame(const cordis_msg_SceneFrame* frame) {
  printf("frame %" PRIu64 " step %" PRIu64 " hash %016" PRIx64, frame->frame, frame->step,
         frame->position_hash);
  for (uint32_t i = 0; i + 2 < frame->position_m._length; i += 3)
    printf(" (%g, %g, %g)", (double)frame->position_m._buffer[i],
           (double)frame->position_m._buffer[i + 1], (double)frame->position_m._buffer[i + 2]);
  printf("\n");
}

int main(int argc, char** argv) {
  const bool frames = argc == 4 && strcmp(argv[3], "frames") == 0;
  if (argc != 4 || (!frames && strcmp(argv[3], "signals") != 0)) {
    fprintf(stderr, "usage: foreign_listen DOMAIN SESSION signals|frames\n");
    return 2;
  }
  setvbuf(stdout, NULL, _IOLBF, 0);
  catch_stop_signals();
  const struct session session = join(argv[1], argv[2]);
  const dds_entity_t scenes = create_reader(&session, &cordis_msg_SceneDescription_desc,
                                            cordis_msg_TOPIC_DESCRIPTION, QOS_TRANSIENT_LOCAL);
  const dds_entity_t reader = frames ? create_reader(&session, &cordis_msg_SceneFrame_desc,
                                                     cordis_msg_TOPIC_FRAME, QOS_STREAM)
                                     : create_reader(&session, &cordis_msg_SceneSignals_desc,
                                                     cordis_msg_TOPIC_SIGNALS, QOS_STREAM);
  const dds_entity_t waitset = create_waitset(&session, reader);
  cordis_msg_SceneDescription scene = {0};
  await_scene(&session, scenes, &scene);
  if (stop_requested()) return 0;
  if (!frames) print_header(&scene);

  cordis_msg_SceneFrame frame = {0};
  cordis_msg_SceneSignals batch = {0};
  while (!stop_requested()) {
    wait_for_message(waitset, kPollPeriodNsec);
    if (take_scene(scenes, &scene) && !frames) print_header(&scene);
    if (frames) {
      while (take(reader, &frame)) print_frame(&frame);
    } else {
      // Around a change of scene some batches belong to the one before.
      while (take(reader, &batch))
        if (batch.version == scene.version) print_signals(&batch, scene.step_rate_hz);
    }
  }
  return 0;
}
