// tests/bench/device_bench.cpp -- what a device costs: a tick of 16 axes, and KFB1 at 1 kHz over a
// pseudo-terminal against the reference firmware.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include <benchmark/benchmark.h>

#include "device_node/device_config.h"
#include "device_node/drivers/kfb1.h"
#include "device_node/exchange.h"
#include "device_node/firmware/kfb1.h"
#include "node/config/yaml_reader.h"
#include "node/latency.h"
#include "node/paced_loop.h"
#include "node/time.h"
#include "tests/device/plug.h"

namespace cordis::device {
namespace {

/// A scene that answers every sample at once with a spring.
class Echo final : public GestureChannel {
 public:
  bool send(const GestureMessage& sample) noexcept override {
    answer_ = sample;
    answer_.epoch = 9;
    answer_.answered_epoch = sample.epoch;
    answer_.answered_sample = sample.sample;
    answer_.answered_time_nsec = sample.time_nsec;
    for (double& value : answer_.value) value *= -200.0;
    fresh_ = true;
    return true;
  }
  bool receive(GestureMessage& answer, std::chrono::nanoseconds) noexcept override {
    if (!std::exchange(fresh_, false)) return false;
    answer = answer_;
    return true;
  }

 private:
  GestureMessage answer_;
  bool fresh_ = false;
};

/// One period of the loop without its sleep and without DDS: sample, answer, guard with energy
/// monitor, simulated keys and hands, sensors.
void device_tick(benchmark::State& state) {
  config::Problems problems;
  const config::Value file =
      config::load_file(CORDIS_SOURCE_DIR "/launch_configs/devices/keyboard_16.yaml", problems);
  LoadedDevice device = read_device(file, "keyboard", problems);
  Echo echo;
  LoopMeter meter;
  Exchange exchange({.config = device.config,
                     .driver = *device.driver,
                     .channel = echo,
                     .meter = meter,
                     .series = {1, 0},
                     .lockstep = true,
                     .clock = &node::monotonic_nsec});
  for (auto _ : state) {
    exchange.send_sample();
    exchange.receive();
    exchange.step();
  }
}
BENCHMARK(device_tick)->Unit(benchmark::kMicrosecond);

std::atomic<int> board_keys{16};
test::Plug* board_plug = nullptr;

/// 10 s at 1 kHz, over a pseudo-terminal or UDP. Counters: cycles whose STATE did not come within
/// their period, damaged frames, the round trip from FORCE to STATE, and what of it had passed when
/// the board had its first byte: the part of the far end and of the machine between.
void kfb1_at_1_khz(benchmark::State& state) {
  std::string folder = (std::filesystem::temp_directory_path() / "cordis-bench-XXXXXX").string();
  folder = mkdtemp(folder.data());
  const bool udp = state.range(0) != 0;
  kfb1 firmware{};
  std::atomic<std::int64_t> asked_nsec = 0;  // 0: the board knows already
  node::LatencyHistogram to_board;
  test::Plug plug(
      [&](std::uint8_t byte) {
        const std::int64_t asked = asked_nsec.exchange(0);
        if (asked != 0) to_board.record(node::monotonic_nsec() - asked);
        kfb1_byte(&firmware, byte);
      },
      [&] { kfb1_tick(&firmware); });
  board_plug = &plug;
  kfb1_board board{};
  board.keys = static_cast<std::uint8_t>(board_keys.load());
  board.travel_um = 40000;
  board.force_mn = 20000;
  board.rate_hz = 1000;
  board.position = [](std::uint8_t) { return std::int16_t{0}; };
  board.force = [](std::uint8_t, std::int16_t) {};
  board.touched = [] { return std::uint16_t{0}; };
  board.time_us = [] { return static_cast<std::uint32_t>(node::monotonic_nsec() / 1000); };
  board.send = [](const std::uint8_t* bytes, std::uint8_t count) {
    board_plug->say({bytes, count});
  };
  kfb1_start(&firmware, &board);
  // The far end is a controller that does nothing else: its thread inherits the priority.
  node::make_realtime(80);
  std::string port = "port: " + folder + "/tty";
  if (udp) {
    port = "udp: '127.0.0.1:" + std::to_string(plug.into_udp()) + "'";
  } else {
    plug.into_serial_line(folder + "/tty");
  }

  config::Problems problems;
  AxisLayout layout;
  layout.count = board_keys;
  const auto driver =
      make_kfb1(config::load_text("{" + port + ", answer_within_s: 0.0009}", "kfb1", problems),
                layout, problems);
  auto& hardware = dynamic_cast<Hardware&>(*driver);
  driver->start(Role::kMass);
  while (!driver->write({})) {
  }
  node::LatencyHistogram round_trip;
  for (auto _ : state) {
    const std::uint64_t late = hardware.late_count();
    node::PacedLoop pace(1000.0);
    int absent = 0;
    for (int n = 0; n < 10000; ++n) {
      pace.wait();
      const std::int64_t begin = node::monotonic_nsec();
      asked_nsec = begin;
      absent += !driver->write({1.0, 2.0});
      round_trip.record(node::monotonic_nsec() - begin);
    }
    state.counters["lost cycles"] = static_cast<double>(hardware.late_count() - late) + absent;
    state.counters["overruns"] = static_cast<double>(pace.overruns());
  }
  state.counters["longest [us]"] = static_cast<double>(round_trip.largest_nsec()) * 1e-3;
  state.counters["damaged"] = static_cast<double>(hardware.bad_count());
  state.counters["p50 [us]"] = round_trip.quantile_nsec(0.5) * 1e-3;
  state.counters["p99 [us]"] = round_trip.quantile_nsec(0.99) * 1e-3;
  plug.pull();
  state.counters["to board p99 [us]"] = to_board.quantile_nsec(0.99) * 1e-3;
  state.counters["to board longest [us]"] = static_cast<double>(to_board.largest_nsec()) * 1e-3;
  std::filesystem::remove_all(folder);
}
BENCHMARK(kfb1_at_1_khz)->ArgName("udp")->Arg(0)->Arg(1)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace cordis::device

BENCHMARK_MAIN();
