// cli/lab/lab_store.cpp
#include "cli/lab/lab_store.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace cordis::cli {
namespace {

constexpr const char* kRuns = "runs.csv";
constexpr const char* kReference = "reference.bin";

std::string first_line(std::uint64_t key) {
  return fmt::format("# cordis lab {:016x}", key);
}

template <class Value>
void put(std::ofstream& file, const Value& value) {
  file.write(reinterpret_cast<const char*>(&value), sizeof(value));
}
template <class Value>
void put(std::ofstream& file, const std::vector<Value>& values) {
  put(file, static_cast<std::uint64_t>(values.size()));
  file.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(Value)));
}
template <class Value>
void take(std::ifstream& file, Value& value) {
  file.read(reinterpret_cast<char*>(&value), sizeof(value));
}
template <class Value>
void take(std::ifstream& file, std::vector<Value>& values) {
  constexpr std::uint64_t kMax = std::uint64_t{1} << 28;
  std::uint64_t count = 0;
  take(file, count);
  if (!file || count > kMax) {
    file.setstate(std::ios::failbit);
    return;
  }
  values.resize(count);
  file.read(reinterpret_cast<char*>(values.data()),
            static_cast<std::streamsize>(count * sizeof(Value)));
}

/// Writes or reads every field: `Step` is put or take.
template <class File, class Of, class Step>
void each_field(File& file, Of& reference, Step step) {
  step(file, reference.sampling.moments);
  step(file, reference.sampling.groups_hz);
  step(file, reference.sampling.resolving_hz);
  step(file, reference.masses);
  step(file, reference.position);
  step(file, reference.kinetic);
  step(file, reference.amplitude);
  step(file, reference.compared);
  step(file, reference.diverged);
  step(file, reference.chaotic);
  step(file, reference.uncertainty);
  step(file, reference.by_reference);
  step(file, reference.evaluations);
}

}  // namespace

LabStore::LabStore(std::filesystem::path folder, std::uint64_t key, bool again)
    : folder_(std::move(folder)), key_(key) {
  std::error_code failure;
  std::filesystem::create_directories(folder_, failure);
  if (failure) {
    throw std::runtime_error("cannot make the folder '" + folder_.string() +
                             "': " + failure.message());
  }
  if (!again) {
    read_runs();
    read_reference();
  }
  if (!reference_) runs_.clear();
  std::ofstream file(folder_ / kRuns);
  file << first_line(key_) << "\n"
       << "integrator,rate_hz,evaluations_per_s,nsec_per_s,instructions_per_s,error,energy_error,"
          "blown_up,blown_up_at_s\n";
  if (!file.flush()) throw std::runtime_error("cannot write " + (folder_ / kRuns).string());
  file.close();
  for (const plan::TrialResult& run : std::exchange(runs_, {})) keep(run);
}

void LabStore::read_runs() {
  std::ifstream file(folder_ / kRuns);
  std::string line;
  if (!std::getline(file, line) || line != first_line(key_)) return;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    plan::TrialResult run;
    words >> run.integrator >> run.rate_hz >> run.evaluations_per_s >> run.nsec_per_s >>
        run.instructions_per_s >> run.error >> run.energy_error >> run.blown_up >> run.blown_up_at;
    if (words) runs_.push_back(run);
  }
}

void LabStore::read_reference() {
  std::ifstream file(folder_ / kReference, std::ios::binary);
  std::uint64_t key = 0;
  take(file, key);
  if (!file || key != key_) return;
  plan::Reference reference;
  each_field(file, reference, [](auto& from, auto& value) { take(from, value); });
  std::vector<char> made_by;
  take(file, made_by);
  reference.made_by.assign(made_by.begin(), made_by.end());
  if (file) reference_ = std::move(reference);
}

void LabStore::keep(const plan::Reference& reference) {
  const std::filesystem::path path = folder_ / kReference;
  std::ofstream file(path, std::ios::binary);
  put(file, key_);
  each_field(file, reference, [](auto& field, const auto& value) { put(field, value); });
  put(file, std::vector<char>(reference.made_by.begin(), reference.made_by.end()));
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
  reference_ = reference;
}

const plan::TrialResult* LabStore::find(const std::string& integrator,
                                        double rate_hz) const noexcept {
  for (const plan::TrialResult& run : runs_) {
    if (run.integrator == integrator && run.rate_hz == rate_hz) return &run;
  }
  return nullptr;
}

void LabStore::keep(const plan::TrialResult& run) {
  const std::lock_guard lock(mutex_);
  std::ofstream file(folder_ / kRuns, std::ios::app);
  file << fmt::format("{},{:.10g},{:.10g},{:.5g},{:.5g},{:.6g},{:.6g},{:d},{:.6g}\n",
                      run.integrator, run.rate_hz, run.evaluations_per_s, run.nsec_per_s,
                      run.instructions_per_s, run.error, run.energy_error, run.blown_up ? 1 : 0,
                      run.blown_up_at);
  if (!file.flush()) throw std::runtime_error("cannot write " + (folder_ / kRuns).string());
  runs_.push_back(run);
}

}  // namespace cordis::cli
