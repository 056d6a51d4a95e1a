// tests/fuzz/seeded_main.cpp -- plays a corpus, and seeded changes of it, into a fuzz target.
//
//   build/asan/bin/fuzz_kfb1 [--runs N] [--seed S] FILE|FOLDER...
//
// Stands for libFuzzer in a build of g++. An input that ends the program is kept in the working
// folder, as crash-TARGET; one that takes 60 s of processor time, as hang-TARGET.
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sanitizer/common_interface_defs.h>
#include <sys/time.h>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Read by the address sanitizer: no allocation above 1 GB, and a signal keeps its input.
extern "C" const char* __asan_default_options() {
  return "max_allocation_size_mb=1024:allocator_may_return_null=0:quarantine_size_mb=16:"
         "handle_abort=1:detect_leaks=1";
}

namespace {

using Input = std::vector<std::uint8_t>;

constexpr std::size_t kLongestInput = 16384;  // [bytes]
constexpr int kPatience = 60;                 // of processor time [s]

std::string target;
const Input* playing = nullptr;

/// Keeps the input that is played. For handlers of signals.
void keep_input(const char* name) {
  if (playing == nullptr) return;
  const int file = open(name, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0) return;
  if (write(file, playing->data(), playing->size()) > 0) std::fprintf(stderr, "kept: %s\n", name);
  close(file);
}

std::string crash_name;
std::string hang_name;

void on_death() {
  keep_input(crash_name.c_str());
}

void on_hang(int) {
  keep_input(hang_name.c_str());
  _exit(1);
}

void play(const Input& input) {
  playing = &input;
  const itimerval limit{.it_interval = {}, .it_value = {.tv_sec = kPatience, .tv_usec = 0}};
  setitimer(ITIMER_PROF, &limit, nullptr);
  const Input exact(input);  // a byte beyond its end is one beyond its memory
  LLVMFuzzerTestOneInput(exact.data(), exact.size());
}

/// Changes some bytes, or takes, repeats, inserts or replaces a part.
void change(Input& input, const std::vector<Input>& corpus, std::mt19937_64& random) {
  constexpr std::uint8_t kEdges[] = {0, 1, 0x7f, 0x80, 0xff, '\n', ' ', '-', '0', '9'};
  const auto below = [&random](std::size_t bound) {
    return bound == 0 ? 0 : static_cast<std::size_t>(random() % bound);
  };
  const std::size_t start = below(input.size() + 1);
  const auto place = input.begin() + static_cast<std::ptrdiff_t>(start);
  const std::size_t length = std::min(input.size() - start, 1 + below(16));
  const auto end = place + static_cast<std::ptrdiff_t>(length);
  switch (random() % 7) {
    case 0:
      if (length > 0) *place ^= static_cast<std::uint8_t>(1u << below(8));
      return;
    case 1:
      for (auto byte = place; byte != end; ++byte) *byte = kEdges[below(std::size(kEdges))];
      return;
    case 2:
      for (auto byte = place; byte != end; ++byte) *byte = static_cast<std::uint8_t>(random());
      return;
    case 3:
      input.erase(place, end);
      return;
    case 4: {
      const Input part(place, end);
      input.insert(input.begin() + static_cast<std::ptrdiff_t>(below(input.size() + 1)),
                   part.begin(), part.end());
      return;
    }
    case 5:
      input.insert(place, kEdges[below(std::size(kEdges))]);
      return;
    default: {
      const Input& other = corpus[below(corpus.size())];
      const std::size_t from = below(other.size() + 1);
      const std::size_t count = std::min(other.size() - from, 1 + below(64));
      const auto first = other.begin() + static_cast<std::ptrdiff_t>(from);
      input.insert(place, first, first + static_cast<std::ptrdiff_t>(count));
    }
  }
}

Input contents_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

}  // namespace

int main(int count, char** words) {
  unsigned long runs = 1000;
  unsigned long seed = 1;
  std::vector<Input> corpus;
  target = std::filesystem::path(words[0]).filename().string();
  crash_name = "crash-" + target;
  hang_name = "hang-" + target;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    if (word == "--runs" && i + 1 < count) {
      runs = std::strtoul(words[++i], nullptr, 10);
    } else if (word == "--seed" && i + 1 < count) {
      seed = std::strtoul(words[++i], nullptr, 10);
    } else if (!std::filesystem::exists(word)) {
      corpus.clear();
      break;
    } else {
      for (const auto& path : files_of(word)) corpus.push_back(contents_of(path));
    }
  }
  if (corpus.empty()) {
    std::fprintf(stderr, "usage: %s [--runs N] [--seed S] FILE|FOLDER...\n", words[0]);
    return 2;
  }
  __sanitizer_set_death_callback(on_death);
  std::signal(SIGPROF, on_hang);
  const std::size_t file_count = corpus.size();
  corpus.emplace_back();
  for (const Input& input : corpus) play(input);
  std::mt19937_64 random(seed);
  for (unsigned long run = 0; run < runs; ++run) {
    Input input = corpus[random() % corpus.size()];
    for (std::uint64_t changes = 1 + random() % 8; changes > 0; --changes)
      change(input, corpus, random);
    input.resize(std::min(input.size(), kLongestInput));
    play(input);
  }
  playing = nullptr;
  std::printf("%s: %zu files and %lu changes of them, seed %lu\n", target.c_str(), file_count, runs,
              seed);
  return 0;
}
