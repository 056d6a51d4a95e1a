/* device_node/firmware/atmega328p.c -- KFB1 on an ATmega328P (Arduino Uno, Nano) with two keys.
 *
 *   positions  potentiometers or linear Hall sensors on A0 and A1, 0 to 5 V over the travel
 *   forces     PWM of 31 kHz on pins 9 and 10 (OC1A, OC1B), direction on pins 4 and 5 (high: up)
 *   host       the serial line, 1 Mbaud
 *
 * avr-gcc -mmcu=atmega328p -Os -std=c99 -I. device_node/firmware/kfb1.c device_node/firmware/atmega328p.c -o keys.elf */
#include <avr/interrupt.h>
#include <avr/io.h>

#include "device_node/firmware/kfb1.h"

enum { PWM_TOP = 511, ROOM = 128 /* bytes, a power of 2 */ };

static volatile uint8_t received[ROOM]; /* bytes of the host not yet taken */
static volatile uint8_t received_end;
static uint8_t received_begin;
static volatile uint32_t turns; /* of timer 0, 256 ticks of 4 us each */

ISR(USART_RX_vect) {
  received[received_end % ROOM] = UDR0;
  ++received_end;
}

ISR(TIMER0_OVF_vect) {
  ++turns;
}

static uint32_t time_us(void) {
  const uint8_t status = SREG;
  cli();
  uint32_t turn = turns;
  const uint8_t tick = TCNT0;
  if ((TIFR0 & _BV(TOV0)) && tick < 128) ++turn; /* the overflow has not been counted yet */
  SREG = status;
  return (turn << 8 | tick) << 2;
}

static int16_t position(uint8_t key) {
  ADMUX = (uint8_t)(_BV(REFS0) | key);
  ADCSRA |= _BV(ADSC);
  while (ADCSRA & _BV(ADSC)) {
  }
  const uint16_t share = ADC; /* 10 bits, spread over 16 */
  const uint16_t spread = (uint16_t)(share << 6 | share >> 4);
  return spread == 0 ? -32767 : (int16_t)(spread ^ 0x8000u);
}

/* A channel without force is taken from the timer: at 0 the timer itself would still give spikes. */
static void force(uint8_t key, int16_t wanted) {
  const uint16_t duty = (uint16_t)(wanted < 0 ? -wanted : wanted) >> 6;
  const uint8_t direction = key == 0 ? _BV(PD4) : _BV(PD5);
  const uint8_t driven = key == 0 ? _BV(COM1A1) : _BV(COM1B1);
  if (duty == 0) TCCR1A &= (uint8_t)~driven;
  if (wanted > 0) {
    PORTD |= direction;
  } else {
    PORTD &= (uint8_t)~direction;
  }
  if (key == 0) {
    OCR1A = duty;
  } else {
    OCR1B = duty;
  }
  if (duty > 0) TCCR1A |= driven;
}

static uint16_t touched(void) {
  return 0;
}

static void send(const uint8_t *bytes, uint8_t count) {
  for (uint8_t i = 0; i < count; ++i) {
    while (!(UCSR0A & _BV(UDRE0))) {
    }
    UDR0 = bytes[i];
  }
}

static void start_board(void) {
  DDRB = _BV(PB1) | _BV(PB2);
  DDRD = _BV(PD4) | _BV(PD5);
  TCCR0B = _BV(CS01) | _BV(CS00); /* 16 MHz / 64 */
  TIMSK0 = _BV(TOIE0);
  ICR1 = PWM_TOP; /* fast PWM, mode 14 */
  TCCR1A = _BV(WGM11);
  TCCR1B = _BV(WGM13) | _BV(WGM12) | _BV(CS10);
  ADCSRA = _BV(ADEN) | _BV(ADPS2) | _BV(ADPS0); /* 500 kHz: 26 us a position */
  UCSR0A = _BV(U2X0);
  UBRR0 = 1; /* 1 Mbaud */
  UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
  UCSR0B = _BV(RXCIE0) | _BV(RXEN0) | _BV(TXEN0);
}

int main(void) {
  static struct kfb1 keyboard;
  static const struct kfb1_board board = {
      .keys = 2, /* the figures are those of the keys: to be changed by who builds them */
      .travel_um = 40000,
      .force_mn = 10000,
      .rate_hz = 1000,
      .serial = 1,
      .position = position,
      .force = force,
      .touched = touched,
      .time_us = time_us,
      .send = send};
  start_board();
  kfb1_start(&keyboard, &board);
  sei();
  for (;;) {
    while (received_begin != received_end) kfb1_byte(&keyboard, received[received_begin++ % ROOM]);
    kfb1_tick(&keyboard);
  }
}
