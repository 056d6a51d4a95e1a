/* device_node/firmware/kfb1.c */
#include "device_node/firmware/kfb1.h"

uint16_t kfb1_crc(const uint8_t *bytes, uint8_t count) {
  uint16_t crc = 0xffffu;
  for (uint8_t i = 0; i < count; ++i) {
    /* x^16 + x^12 + x^5 + 1, eight bits at once: its terms stand far enough apart */
    uint8_t x = (uint8_t)((uint8_t)(crc >> 8) ^ bytes[i]);
    x = (uint8_t)(x ^ x >> 4);
    crc = (uint16_t)((uint16_t)(crc << 8) ^ (uint16_t)((uint16_t)x << 12) ^
                     (uint16_t)((uint16_t)x << 5) ^ x);
  }
  return crc;
}

uint8_t kfb1_encode(const uint8_t *in, uint8_t count, uint8_t *out) {
  uint8_t length = 1;
  uint8_t code_at = 0;
  uint8_t code = 1;
  for (uint8_t i = 0; i < count; ++i) {
    if (in[i] != 0) {
      out[length++] = in[i];
      ++code;
      continue;
    }
    out[code_at] = code;
    code_at = length++;
    code = 1;
  }
  out[code_at] = code;
  out[length++] = 0;
  return length;
}

uint8_t kfb1_decode(const uint8_t *in, uint8_t count, uint8_t *out) {
  uint8_t length = 0;
  uint8_t i = 0;
  while (i < count) {
    const uint8_t code = in[i++];
    if (code == 0 || (uint16_t)i + code - 1u > count) return 0;
    for (uint8_t k = 1; k < code; ++k) out[length++] = in[i++];
    if (i < count) out[length++] = 0;
  }
  return length;
}

static void put16(uint8_t *bytes, uint16_t value) {
  bytes[0] = (uint8_t)value;
  bytes[1] = (uint8_t)(value >> 8);
}

static void put32(uint8_t *bytes, uint32_t value) {
  put16(bytes, (uint16_t)value);
  put16(bytes + 2, (uint16_t)(value >> 16));
}

static uint16_t get16(const uint8_t *bytes) {
  return (uint16_t)(bytes[0] | (uint16_t)((uint16_t)bytes[1] << 8));
}

static uint32_t get32(const uint8_t *bytes) {
  return get16(bytes) | ((uint32_t)get16(bytes + 2) << 16);
}

/* The payload must have room for two bytes more. */
static void send_payload(struct kfb1 *device, uint8_t *payload, uint8_t count) {
  uint8_t frame[KFB1_LARGEST_FRAME];
  put16(payload + count, kfb1_crc(payload, count));
  device->board.send(frame, kfb1_encode(payload, (uint8_t)(count + 2u), frame));
}

static void send_state(struct kfb1 *device, uint8_t sequence) {
  uint8_t payload[KFB1_LARGEST_PAYLOAD];
  const uint8_t keys = device->board.keys;
  payload[0] = KFB1_STATE;
  payload[1] = sequence;
  payload[2] = keys;
  payload[3] = 0;
  put32(payload + 4, device->board.time_us());
  for (uint8_t key = 0; key < keys; ++key) {
    put16(payload + 8 + 2 * key, (uint16_t)device->board.position(key));
  }
  put16(payload + 8 + 2 * keys, device->board.touched());
  send_payload(device, payload, (uint8_t)(10u + 2u * keys));
}

static void send_info(struct kfb1 *device) {
  uint8_t payload[KFB1_LARGEST_PAYLOAD];
  payload[0] = KFB1_INFO;
  payload[1] = 1;
  payload[2] = device->board.keys;
  put32(payload + 3, device->board.travel_um);
  put32(payload + 7, device->board.force_mn);
  put16(payload + 11, device->board.rate_hz);
  put32(payload + 13, device->board.serial);
  send_payload(device, payload, 17);
}

static void release(struct kfb1 *device) {
  for (uint8_t key = 0; key < device->board.keys; ++key) device->board.force(key, 0);
  device->driven = 0;
}

static void take_forces(struct kfb1 *device, const uint8_t *payload, uint8_t count) {
  const uint8_t keys = device->board.keys;
  if (count < 4 || payload[2] != keys || count != (uint8_t)(4u + 2u * keys)) return;
  device->driven = 0;
  for (uint8_t key = 0; key < keys; ++key) {
    int16_t force = (int16_t)get16(payload + 4 + 2 * key);
    if (force != 0) device->driven = 1;
    if (force > device->limit) force = device->limit;
    if (force < -device->limit) force = (int16_t)-device->limit;
    device->board.force(key, force);
  }
  device->last_force_us = device->board.time_us();
  send_state(device, payload[1]);
}

/* CONFIG: rate u16, force limit mN u32. The limit of the board itself wins. */
static void take_config(struct kfb1 *device, const uint8_t *payload, uint8_t count) {
  if (count != 7) return;
  const uint32_t wanted = get32(payload + 3);
  const uint32_t most = device->board.force_mn;
  device->limit = wanted >= most ? 32767 : (int16_t)((uint64_t)wanted * 32767u / most);
}

static void take_frame(struct kfb1 *device) {
  uint8_t payload[KFB1_LARGEST_FRAME];
  const uint8_t count = kfb1_decode(device->frame, device->length, payload);
  if (count < 3) return;
  if (kfb1_crc(payload, (uint8_t)(count - 2u)) != get16(payload + count - 2)) return;
  switch (payload[0]) {
    case KFB1_FORCE:
      take_forces(device, payload, (uint8_t)(count - 2u));
      break;
    case KFB1_HELLO:
      send_info(device);
      break;
    case KFB1_CONFIG:
      take_config(device, payload, (uint8_t)(count - 2u));
      break;
    default: /* of a later version */
      break;
  }
}

void kfb1_start(struct kfb1 *device, const struct kfb1_board *board) {
  device->board = *board;
  device->length = 0;
  device->too_long = 0;
  device->limit = 32767;
  device->last_force_us = 0;
  release(device);
}

void kfb1_byte(struct kfb1 *device, uint8_t byte) {
  if (byte == 0) {
    if (device->length > 0 && !device->too_long) take_frame(device);
    device->length = 0;
    device->too_long = 0;
  } else if (device->length < KFB1_LARGEST_FRAME) {
    device->frame[device->length++] = byte;
  } else {
    device->too_long = 1;
  }
}

void kfb1_event(struct kfb1 *device, uint8_t code) {
  uint8_t payload[KFB1_LARGEST_PAYLOAD];
  payload[0] = KFB1_EVENT;
  payload[1] = code;
  send_payload(device, payload, 2);
}

void kfb1_tick(struct kfb1 *device) {
  const uint32_t silent_us = device->board.time_us() - device->last_force_us;
  if (!device->driven || silent_us <= KFB1_WATCHDOG_MS * 1000ul) return;
  release(device);
  kfb1_event(device, KFB1_WATCHDOG);
}
