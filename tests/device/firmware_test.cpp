// tests/device/firmware_test.cpp -- the reference firmware as AVR code, on a simulated ATmega328P.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <simavr/avr_adc.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>

#include "device_node/firmware/kfb1.h"
#include "tests/device/plug.h"
#include "tests/device/wired.h"

namespace cordis::device {
namespace {

constexpr std::uint64_t kCyclesPerMsec = 16'000;
constexpr int kFullDuty = 511;

// Registers of the ATmega328P, in its data space.
constexpr std::size_t kPortD = 0x2b;
constexpr std::size_t kControl = 0x80;                      // TCCR1A
constexpr std::array<std::size_t, 2> kDuty = {0x88, 0x8a};  // OCR1A, OCR1B
constexpr std::array<std::uint8_t, 2> kDriven = {0x80, 0x20};
constexpr std::array<std::uint8_t, 2> kUp = {0x10, 0x20};

/// An ATmega328P of 16 MHz that runs what avr-gcc made of the firmware and of its board. Time goes
/// on in run() alone.
class Chip {
 public:
  Chip() : avr_(avr_make_mcu_by_name("atmega328p")) {
    elf_firmware_t code{};
    EXPECT_EQ(elf_read_firmware(CORDIS_FIRMWARE_ELF, &code), 0);
    avr_init(avr_);
    avr_->frequency = 16'000'000;
    avr_->vcc = avr_->avcc = avr_->aref = 5000;
    avr_load_firmware(avr_, &code);
    std::uint32_t flags = 0;
    avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    avr_irq_register_notify(
        avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
        [](avr_irq_t*, std::uint32_t value, void* chip) {
          static_cast<Chip*>(chip)->said.push_back(static_cast<std::uint8_t>(value));
        },
        this);
    press(0, 0.5);
    press(1, 0.5);
    run(2.0);
  }
  ~Chip() { avr_terminate(avr_); }
  Chip(const Chip&) = delete;
  Chip& operator=(const Chip&) = delete;

  /// @param share  of the travel, 0 at its lower end
  void press(int key, double share) {
    avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0 + key),
                  static_cast<std::uint32_t>(share * 5000.0));
  }
  void receive(std::uint8_t byte) {
    avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT), byte);
  }
  void receive(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) receive(byte);
  }
  void run(double msec) {
    const avr_cycle_count_t end =
        avr_->cycle + static_cast<avr_cycle_count_t>(msec * kCyclesPerMsec);
    while (avr_->cycle < end) {
      const int state = avr_run(avr_);
      ASSERT_TRUE(state == cpu_Running || state == cpu_Sleeping) << "the program has crashed";
    }
  }
  double msec() const { return static_cast<double>(avr_->cycle) / kCyclesPerMsec; }

  /// What a motor is given: -511..511.
  int duty(std::size_t key) const {
    const std::uint8_t* data = avr_->data;
    if ((data[kControl] & kDriven[key]) == 0) return 0;
    const int value = data[kDuty[key]] + 256 * data[kDuty[key] + 1];
    return (data[kPortD] & kUp[key]) != 0 ? value : -value;
  }

  std::vector<std::uint8_t> said;

 private:
  avr_t* avr_;
};

std::vector<std::uint8_t> force_frame(std::uint8_t sequence, std::int16_t first,
                                      std::int16_t second) {
  std::array<std::uint8_t, KFB1_LARGEST_PAYLOAD> payload{};
  payload[0] = KFB1_FORCE;
  payload[1] = sequence;
  payload[2] = 2;
  for (int key = 0; key < 2; ++key) {
    const auto value = static_cast<std::uint16_t>(key == 0 ? first : second);
    payload[4 + 2 * key] = static_cast<std::uint8_t>(value & 0xff);
    payload[5 + 2 * key] = static_cast<std::uint8_t>(value >> 8);
  }
  const std::uint16_t crc = kfb1_crc(payload.data(), 8);
  payload[8] = static_cast<std::uint8_t>(crc & 0xff);
  payload[9] = static_cast<std::uint8_t>(crc >> 8);
  std::vector<std::uint8_t> frame(KFB1_LARGEST_FRAME);
  frame.resize(kfb1_encode(payload.data(), 10, frame.data()));
  return frame;
}

TEST(Firmware, AnswersEveryForceWithinAPeriod) {
  Chip chip;
  chip.press(0, 1.0);
  double slowest = 0.0;
  for (std::uint8_t n = 1; n <= 20; ++n) {
    chip.said.clear();
    chip.receive(force_frame(n, 32767, -16384));
    const double begin = chip.msec();
    while (chip.msec() < begin + 5.0 && (chip.said.empty() || chip.said.back() != 0)) {
      chip.run(0.01);
    }
    slowest = std::max(slowest, chip.msec() - begin);

    std::array<std::uint8_t, KFB1_LARGEST_FRAME> state{};
    ASSERT_EQ(kfb1_decode(chip.said.data(), static_cast<std::uint8_t>(chip.said.size() - 1),
                          state.data()),
              16);
    EXPECT_EQ(kfb1_crc(state.data(), 14), state[14] + 256 * state[15]);
    EXPECT_EQ(state[0], KFB1_STATE);
    EXPECT_EQ(state[1], n);
    EXPECT_EQ(state[8] + 256 * state[9], 32767) << "the key is up";
  }
  EXPECT_EQ(chip.duty(0), kFullDuty);
  EXPECT_EQ(chip.duty(1), -256);
  EXPECT_LT(slowest, 1.0);
  std::printf("FORCE to STATE of 2 keys on an ATmega328P, bytes included: %.2f ms\n", slowest);
}

TEST(Firmware, LetsGoTwentyMillisecondsAfterTheLastForce) {
  Chip chip;
  chip.receive(force_frame(1, 20000, 20000));
  chip.run(15.0);
  EXPECT_GT(chip.duty(0), 0);
  chip.run(4.0);
  EXPECT_GT(chip.duty(1), 0);

  chip.said.clear();
  chip.run(3.0);

  EXPECT_EQ(chip.duty(0), 0);
  EXPECT_EQ(chip.duty(1), 0);
  std::array<std::uint8_t, KFB1_LARGEST_FRAME> event{};
  ASSERT_FALSE(chip.said.empty());
  ASSERT_EQ(
      kfb1_decode(chip.said.data(), static_cast<std::uint8_t>(chip.said.size() - 1), event.data()),
      4);
  EXPECT_EQ(event[0], KFB1_EVENT);
  EXPECT_EQ(event[1], KFB1_WATCHDOG);
}

TEST(Firmware, BelievesNoDamagedFrame) {
  Chip chip;
  const std::vector<std::uint8_t> good = force_frame(1, 20000, 20000);
  for (std::size_t damaged = 0; damaged < good.size(); ++damaged) {
    std::vector<std::uint8_t> bad = good;
    bad[damaged] ^= 0x14;
    chip.said.clear();
    chip.receive(bad);
    chip.receive(0);
    chip.run(0.6);
    EXPECT_EQ(chip.duty(0), 0) << damaged;
    EXPECT_TRUE(chip.said.empty()) << damaged;
  }

  chip.receive(good);
  chip.run(0.6);
  EXPECT_GT(chip.duty(0), 0) << "and goes on with the next good one";
}

class FirmwareTest : public Wired {};

TEST_F(FirmwareTest, PlaysWithTheDriver) {
  Chip chip;
  std::array<std::atomic<int>, 2> duty{};
  std::atomic<double> pressed{0.75};
  test::Plug* said_through = nullptr;
  test::Plug plug([&](std::uint8_t byte) { chip.receive(byte); },
                  [&] {
                    chip.press(0, pressed);
                    chip.run(1.0);
                    if (!chip.said.empty()) said_through->say(chip.said);
                    chip.said.clear();
                    for (std::size_t key = 0; key < 2; ++key) duty[key] = chip.duty(key);
                  });
  said_through = &plug;
  plug.is_prompt = false;
  plug.into_serial_line(link());
  AxisLayout layout;
  layout.count = 2;
  layout.lowest_m = -0.04;
  layout.highest_m = 0.0;
  const auto keys = driver("kfb1", port(), layout);
  keys->start(Role::kMass);

  AxisValues sensed{};
  const auto is_at = [&](double position_m) {
    return [&keys, &sensed, position_m](bool there) {
      return there && keys->read(sensed) && std::abs(sensed[0] - position_m) < 5e-5;  // 10 bits
    };
  };
  EXPECT_TRUE(until(*keys, {5.0, -10.0}, is_at(-0.01)));
  EXPECT_TRUE(
      until(*keys, {5.0, -10.0}, [&](bool) { return duty[0] == 256 && duty[1] == -kFullDuty; }));
  pressed = 0.25;
  EXPECT_TRUE(until(*keys, {5.0, -10.0}, is_at(-0.03))) << sensed[0];

  keys->stop();
  EXPECT_TRUE(until(*keys, {}, [&](bool) { return duty[0] == 0 && duty[1] == 0; }));
}

}  // namespace
}  // namespace cordis::device
