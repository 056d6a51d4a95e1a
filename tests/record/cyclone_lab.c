// tests/record/cyclone_lab.c -- a program of CycloneDDS that counts on lab/count, or prints what it
// receives there, after the line `matched`; until a signal ends it.
// usage: cyclone_lab DOMAIN write, or cyclone_lab DOMAIN read SESSION
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "count.h"
#include "dds/dds.h"

static dds_entity_t checked(dds_entity_t entity, const char* what) {
  if (entity >= 0) return entity;
  fprintf(stderr, "cyclone_lab: no %s: %s\n", what, dds_strretcode(entity));
  exit(1);
}

static void count_up(dds_entity_t participant, dds_entity_t topic, const dds_qos_t* qos) {
  const dds_entity_t writer = checked(dds_create_writer(participant, topic, qos, NULL), "writer");
  for (lab_Count count = {.number = 0};; ++count.number) {
    if (dds_write(writer, &count) < 0) exit(1);
    dds_sleepfor(DDS_MSECS(5));
  }
}

static void print_all(dds_entity_t participant, dds_entity_t topic, const dds_qos_t* qos) {
  const dds_entity_t subscriber =
      checked(dds_create_subscriber(participant, qos, NULL), "subscriber");
  const dds_entity_t reader = checked(dds_create_reader(subscriber, topic, qos, NULL), "reader");
  dds_subscription_matched_status_t matched = {0};
  while (matched.current_count == 0) {
    dds_sleepfor(DDS_MSECS(5));
    if (dds_get_subscription_matched_status(reader, &matched) < 0) exit(1);
  }
  printf("matched\n");
  fflush(stdout);
  for (;;) {
    void* samples[1] = {NULL};
    dds_sample_info_t info[1];
    if (dds_take(reader, samples, info, 1, 1) < 1) {
      dds_sleepfor(DDS_MSECS(5));
      continue;
    }
    if (info[0].valid_data) printf("number %u\n", ((const lab_Count*)samples[0])->number);
    fflush(stdout);
    dds_return_loan(reader, samples, 1);
  }
}

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const dds_entity_t participant =
      checked(dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL), "participant");
  const dds_entity_t topic =
      checked(dds_create_topic(participant, &lab_Count_desc, "lab/count", NULL, NULL), "topic");
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  if (strcmp(argv[2], "write") == 0) count_up(participant, topic, qos);
  if (argc < 4) return 2;
  const char* partition[] = {argv[3]};
  dds_qset_partition(qos, 1, partition);
  print_all(participant, topic, qos);
}
