// tests/bench/mcap_bench.cpp -- what writing, reading and recovering a take costs.
//
// The messages are those of 16 keys at 1 kHz and 10,000 balls at 25 Hz.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "record_node/mcap/reader.h"
#include "record_node/mcap/recover.h"
#include "record_node/mcap/writer.h"

namespace {

using namespace cordis::mcap;

constexpr std::size_t kGestureSize = 4 + 56 + 8 * 16;  // a GesturePositions as CDR [bytes]
constexpr std::size_t kFrameSize = 64 + 12 * 10'000;   // a SceneFrame of 10,000 balls
constexpr std::uint64_t kTick = 1'000'000;             // [ns]
constexpr int kTicksPerFrame = 40;

std::filesystem::path path_of(const std::string& name) {
  return std::filesystem::temp_directory_path() /
         ("cordis_mcap_bench_" + std::to_string(::getpid()) + "_" + name);
}

/// Numbers like positions: most of their bits are noise.
std::vector<std::byte> noise(std::size_t size) {
  std::mt19937 random(1);
  std::normal_distribution<float> position(0.0F, 0.1F);
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i + sizeof(float) <= size; i += sizeof(float)) {
    const float value = position(random);
    std::memcpy(bytes.data() + i, &value, sizeof value);
  }
  return bytes;
}

/// Writes `seconds` of a session. @return bytes of its messages
std::int64_t write_session(Writer& writer, int seconds) {
  const std::vector<std::byte> gesture = noise(kGestureSize);
  std::vector<std::byte> frame = noise(kFrameSize);
  const std::uint16_t keys = writer.add_channel({0, 0, "gesture/positions", "cdr", {}});
  const std::uint16_t forces = writer.add_channel({0, 0, "gesture/forces", "cdr", {}});
  const std::uint16_t frames = writer.add_channel({0, 0, "scene/frame", "cdr", {}});
  std::uint64_t now = kTick;
  std::int64_t bytes = 0;
  for (int tick = 0; tick < 1000 * seconds; ++tick, now += kTick) {
    const auto sequence = static_cast<std::uint32_t>(tick);
    for (const std::uint16_t channel : {keys, forces})
      static_cast<void>(writer.write({channel, sequence, now, now, gesture}));
    bytes += 2 * std::ssize(gesture);
    if (tick % kTicksPerFrame == 0) {
      std::rotate(frame.begin(), frame.begin() + 12, frame.end());
      static_cast<void>(writer.write({frames, sequence, now, now, frame}));
      bytes += std::ssize(frame);
    }
    static_cast<void>(writer.close_chunk_if_older(now));
  }
  return bytes;
}

WriterConfig config_of(const benchmark::State& state) {
  WriterConfig config;
  config.compression = static_cast<Compression>(state.range(0));
  return config;
}

void write_take(benchmark::State& state) {
  const auto path = path_of("write");
  constexpr int kSeconds = 10;
  std::int64_t bytes = 0;
  for (auto _ : state) {
    Writer writer(path, config_of(state));
    bytes += write_session(writer, kSeconds);
    static_cast<void>(writer.close());
    std::filesystem::remove(path);
  }
  state.SetBytesProcessed(bytes);
}

/// Recovers a take whose recorder died: no summary, the last chunk torn.
void recover_take(benchmark::State& state) {
  const auto path = path_of("recover");
  const auto torn = path_of("torn");
  constexpr int kSeconds = 90;
  {
    Writer writer(torn, config_of(state));
    write_session(writer, kSeconds);
    static_cast<void>(writer.close());
  }
  const Reader whole(torn);
  const ChunkIndex last = whole.chunks().back();
  std::filesystem::resize_file(torn, last.offset + last.length / 2);
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(torn));
  std::int64_t bytes = 0;
  for (auto _ : state) {
    state.PauseTiming();
    std::filesystem::copy_file(torn, path, std::filesystem::copy_options::overwrite_existing);
    state.ResumeTiming();
    if (!recover(path).has_loss()) state.SkipWithError("nothing was torn");
    bytes += size;
  }
  state.SetBytesProcessed(bytes);
  std::filesystem::remove(torn);
  std::filesystem::remove(path);
}

void read_take(benchmark::State& state) {
  const auto path = path_of("read");
  constexpr int kSeconds = 30;
  Writer writer(path, config_of(state));
  const std::int64_t bytes = write_session(writer, kSeconds);
  static_cast<void>(writer.close());
  for (auto _ : state) {
    const Reader reader(path);
    MessageCursor cursor = reader.messages();
    for (Message message; cursor.next(message);) benchmark::DoNotOptimize(message.data.data());
  }
  state.SetBytesProcessed(bytes * static_cast<std::int64_t>(state.iterations()));
  std::filesystem::remove(path);
}

// The argument is the compression: none, lz4, zstd.
BENCHMARK(write_take)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(recover_take)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(read_take)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
