// tests/idl/cyclone_reader.c -- a program of CycloneDDS that prints what the nodes of a session
// say, until a signal ends it. usage: cyclone_reader DOMAIN SESSION
#include <stdio.h>
#include <stdlib.h>

#include "control.h"
#include "dds/dds.h"

static dds_entity_t checked(dds_entity_t entity, const char* what) {
  if (entity >= 0) return entity;
  fprintf(stderr, "cyclone_reader: no %s: %s\n", what, dds_strretcode(entity));
  exit(1);
}

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const dds_domainid_t domain = (dds_domainid_t)atoi(argv[1]);
  const char* partition[] = {argv[2]};
  dds_qos_t* qos = dds_create_qos();
  dds_qset_partition(qos, 1, partition);
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  const dds_entity_t participant =
      checked(dds_create_participant(domain, NULL, NULL), "participant");
  const dds_entity_t topic =
      checked(dds_create_topic(participant, &cordis_msg_NodeStatus_desc, "node/status", NULL, NULL),
              "topic");
  const dds_entity_t subscriber =
      checked(dds_create_subscriber(participant, qos, NULL), "subscriber");
  const dds_entity_t reader = checked(dds_create_reader(subscriber, topic, qos, NULL), "reader");

  for (;;) {
    void* samples[1] = {NULL};
    dds_sample_info_t info[1];
    if (dds_take(reader, samples, info, 1, 1) < 1) {
      dds_sleepfor(DDS_MSECS(10));
      continue;
    }
    const cordis_msg_NodeStatus* status = samples[0];
    if (info[0].valid_data) printf("%s %s %s\n", status->node, status->kind, status->phase);
    fflush(stdout);
    dds_return_loan(reader, samples, 1);
  }
}
