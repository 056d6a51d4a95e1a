// tests/idl/cyclone_reader.c -- a program of CycloneDDS that prints what the nodes of a session
// say, until a signal ends it. usage: cyclone_reader DOMAIN SESSION [VERSION]. With VERSION it also
// describes a device, of that version of the wire, and sends its positions.
#include <stdio.h>
#include <stdlib.h>

#include "control.h"
#include "dds/dds.h"
#include "gesture.h"
#include "topics.h"

static dds_entity_t checked(dds_entity_t entity, const char* what) {
  if (entity >= 0) return entity;
  fprintf(stderr, "cyclone_reader: no %s: %s\n", what, dds_strretcode(entity));
  exit(1);
}

/// A writer of a topic with the reliability and durability of `qos`.
static dds_entity_t writer(dds_entity_t participant, dds_entity_t publisher, const char* name,
                           const dds_topic_descriptor_t* type, const dds_qos_t* qos) {
  const dds_entity_t topic =
      checked(dds_create_topic(participant, type, name, NULL, NULL), "topic");
  return checked(dds_create_writer(publisher, topic, qos, NULL), "writer");
}

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) return 2;
  const uint32_t version = argc == 4 ? (uint32_t)atoi(argv[3]) : 0;
  const dds_domainid_t domain = (dds_domainid_t)atoi(argv[1]);
  const char* partition[] = {argv[2]};
  dds_qos_t* qos = dds_create_qos();
  dds_qset_partition(qos, 1, partition);
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  const dds_entity_t participant =
      checked(dds_create_participant(domain, NULL, NULL), "participant");
  const dds_entity_t topic = checked(dds_create_topic(participant, &cordis_msg_NodeStatus_desc,
                                                      cordis_msg_TOPIC_STATUS, NULL, NULL),
                                     "topic");
  const dds_entity_t subscriber =
      checked(dds_create_subscriber(participant, qos, NULL), "subscriber");
  const dds_entity_t reader = checked(dds_create_reader(subscriber, topic, qos, NULL), "reader");

  const dds_entity_t publisher = checked(dds_create_publisher(participant, qos, NULL), "publisher");
  dds_entity_t positions = 0;
  cordis_msg_GesturePositions sample = {.device_id = 1, .epoch = 1, .axis_count = 1};
  if (version != 0) {
    const dds_entity_t descriptions = writer(participant, publisher, cordis_msg_TOPIC_DEVICE,
                                             &cordis_msg_DeviceDescription_desc, qos);
    positions = writer(participant, publisher, cordis_msg_TOPIC_POSITIONS,
                       &cordis_msg_GesturePositions_desc, NULL);
    const cordis_msg_DeviceDescription description = {
        .device_id = 1, .wire_version = version, .device = "key", .driver = "cyclone"};
    if (dds_write(descriptions, &description) < 0) return 1;
  }

  for (;;) {
    ++sample.sample;
    if (positions != 0) dds_write(positions, &sample);
    void* samples[1] = {NULL};
    dds_sample_info_t info[1];
    if (dds_take(reader, samples, info, 1, 1) < 1) {
      dds_sleepfor(DDS_MSECS(10));
      continue;
    }
    const cordis_msg_NodeStatus* status = samples[0];
    if (info[0].valid_data) {
      printf("%s kind %d phase %d\n", status->node, (int)status->kind, (int)status->phase);
    }
    fflush(stdout);
    dds_return_loan(reader, samples, 1);
  }
}
