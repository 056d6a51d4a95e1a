/* device_node/firmware/kfb1.h -- KFB1, the device's side: for a keyboard that you build.
 *
 * Plain C99 without a heap, an operating system or floating point: fits an ATmega328P. A board gives
 * it five functions and calls two; see docs/kfb1.md for the protocol and atmega328p.c for a board. */
#ifndef CORDIS_KFB1_H
#define CORDIS_KFB1_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  KFB1_MAX_KEYS = 16,
  KFB1_WATCHDOG_MS = 20,     /* without FORCE, forces are 0 */
  KFB1_LARGEST_PAYLOAD = 64, /* STATE of 16 keys: 43 bytes with its CRC */
  KFB1_LARGEST_FRAME = 66    /* with COBS and the 0 at the end */
};

enum kfb1_type {
  KFB1_STATE = 0x01,
  KFB1_FORCE = 0x02,
  KFB1_HELLO = 0x03,
  KFB1_INFO = 0x04,
  KFB1_CONFIG = 0x05,
  KFB1_EVENT = 0x06
};

/* Codes of EVENT. At all but KFB1_SATURATED the host takes its forces back, and ramps them up again. */
enum kfb1_event_code {
  KFB1_TOO_HOT = 1,
  KFB1_EMERGENCY_STOP = 2,
  KFB1_SATURATED = 3,
  KFB1_WATCHDOG = 4 /* sent by kfb1_tick */
};

/* What a board is, and how it is asked and answered. */
struct kfb1_board {
  uint8_t keys;       /* 1..16 */
  uint32_t travel_um; /* of every key */
  uint32_t force_mn;  /* largest force of a motor */
  uint16_t rate_hz;   /* highest rate of exchanges */
  uint32_t serial;
  int16_t (*position)(uint8_t key);          /* -32767 lower end .. 32767 upper end */
  void (*force)(uint8_t key, int16_t force); /* -32767..32767 of force_mn, up positive */
  uint16_t (*touched)(void);                 /* one bit per key */
  uint32_t (*time_us)(void);
  void (*send)(const uint8_t* bytes, uint8_t count);
};

struct kfb1 {
  struct kfb1_board board;
  uint8_t frame[KFB1_LARGEST_FRAME]; /* bytes since the last 0 */
  uint8_t length;
  uint8_t too_long;
  uint8_t driven; /* a FORCE other than 0 has come within the watchdog time */
  uint32_t last_force_us;
  int16_t limit; /* of forces, as CONFIG set it */
};

void kfb1_start(struct kfb1* device, const struct kfb1_board* board);

/* For every byte that arrives. */
void kfb1_byte(struct kfb1* device, uint8_t byte);

/* At least once a millisecond: the watchdog. */
void kfb1_tick(struct kfb1* device);

/* Sends an EVENT. While the cause lasts, call it every 50 ms or sooner, and give no force. */
void kfb1_event(struct kfb1* device, uint8_t code);

/* What both sides need; the host has its own. */
uint16_t kfb1_crc(const uint8_t* bytes, uint8_t count);              /* CRC-16/CCITT-FALSE */
uint8_t kfb1_encode(const uint8_t* in, uint8_t count, uint8_t* out); /* COBS, with the 0; length */
uint8_t kfb1_decode(const uint8_t* in, uint8_t count, uint8_t* out); /* without the 0; 0: bad */

#ifdef __cplusplus
}
#endif

#endif
