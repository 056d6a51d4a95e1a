// sim_node/engine/core/archive.h -- one walk over a state saves, measures, checks, restores and
// hashes it.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "node/assert.h"
#include "sim_node/engine/core/state_hash.h"

namespace cordis::engine {

/// What a class shows its state to. Its one function serialize(Archive&) names each value, always
/// in the same order; the task of the archive decides what becomes of them. A saved state is a row
/// of doubles, exact for whole numbers up to 2^53.
///
/// A row is checked before it is restored, with the same walk: nothing has changed when it is
/// refused. A row that is too short is never read beyond its end.
class Archive {
 public:
  /// Saves: appends the values to the row. Allocates unless the row has room.
  static Archive saving(std::vector<double>& row) { return {Task::kSave, {}, &row, nullptr}; }
  /// Counts the values of the longest state: size().
  static Archive measuring() { return {Task::kMeasure, {}, nullptr, nullptr}; }
  /// Finds out if the row can be restored: matches().
  static Archive checking(std::span<const double> row) {
    return {Task::kCheck, row, nullptr, nullptr};
  }
  /// Restores. Precondition: the row has been checked, and matches().
  static Archive restoring(std::span<const double> row) {
    return {Task::kRestore, row, nullptr, nullptr};
  }
  /// Adds to the hash what is shown to hash() and hash_rows().
  static Archive hashing(StateHash& hash) { return {Task::kHash, {}, nullptr, &hash}; }

  bool saves() const noexcept { return task_ == Task::kSave; }
  bool restores() const noexcept { return task_ == Task::kRestore; }
  bool hashes() const noexcept { return task_ == Task::kHash; }
  /// Values counted.
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// True if the row held all values and no others, and each fitted.
  [[nodiscard]] bool matches() const noexcept { return fits_ && row_.empty(); }

  /// Real numbers; any of them is a state, NaN too.
  void reals(std::span<double> values) {
    if (task_ == Task::kSave) saved_->insert(saved_->end(), values.begin(), values.end());
    if (task_ == Task::kMeasure) size_ += values.size();
    if (!reads()) return;
    const std::span<const double> from = take(values.size());
    if (restores()) std::copy(from.begin(), from.end(), values.begin());
  }
  void real(double& value) { reals({&value, 1}); }

  /// Whole numbers. @param fits  (index, value): true if the value may be restored
  template <std::unsigned_integral Whole, class Fits>
  void wholes(std::span<Whole> values, Fits fits) {
    if (task_ == Task::kSave) saved_->insert(saved_->end(), values.begin(), values.end());
    if (task_ == Task::kMeasure) size_ += values.size();
    if (!reads()) return;
    const std::span<const double> from = take(values.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (restores()) {
        CORDIS_ASSERT(is_exact<Whole>(from[i]) && fits(i, static_cast<Whole>(from[i])));
        values[i] = static_cast<Whole>(from[i]);
      } else if (!is_exact<Whole>(from[i]) || !fits(i, static_cast<Whole>(from[i]))) {
        fits_ = false;
      }
    }
  }
  /// One of them. @param fits  (value)
  template <std::unsigned_integral Whole, class Fits>
  void whole(Whole& value, Fits fits) {
    wholes(std::span<Whole>(&value, 1), [&fits](std::size_t, Whole read) { return fits(read); });
  }
  void flag(bool& value) {
    std::uint8_t bit = value ? 1 : 0;
    whole(bit, [](std::uint8_t read) { return read <= 1; });
    value = bit != 0;
  }

  /// How many records follow, at most `max`. @return of how many the walk is: those of the row when
  /// it reads, `max` when it measures.
  std::size_t count(std::size_t& value, std::size_t max) {
    std::size_t walked = task_ == Task::kMeasure ? max : value;
    const std::span<const double> next = row_;
    whole(value, [max](std::size_t read) { return read <= max; });
    if (reads()) walked = fits_ ? static_cast<std::size_t>(next.front()) : 0;
    return walked;
  }

  /// Records of real and whole numbers, field by field. @param fits  (index, record)
  template <class Record, class Fits, class... Field>
  void records(std::span<Record> records, Fits fits, Field Record::*... field) {
    const std::size_t value_count = records.size() * sizeof...(field);
    if (task_ == Task::kSave) {
      saved_->resize(saved_->size() + value_count);
      double* target = saved_->data() + saved_->size() - value_count;
      for (const Record& record : records) ((*target++ = static_cast<double>(record.*field)), ...);
    }
    if (task_ == Task::kMeasure) size_ += value_count;
    if (!reads()) return;
    const double* from = take(value_count).data();
    if (from == nullptr) return;
    for (std::size_t i = 0; i < records.size() && fits_; ++i) {
      const double* first = from + i * sizeof...(field);
      const double* next = first;
      if (restores()) {
        CORDIS_ASSERT(are_exact<Field...>(first));
        ((records[i].*field = static_cast<Field>(*next++)), ...);
        CORDIS_ASSERT(fits(i, records[i]));
        continue;
      }
      Record read;
      fits_ = are_exact<Field...>(first);
      if (fits_) ((read.*field = static_cast<Field>(*next++)), ...);
      fits_ = fits_ && fits(i, read);
    }
  }

  /// Values of the hash, which need not be those that are saved.
  void hash(std::span<const double> values) noexcept {
    if (!hashes()) return;
    for (const double value : values) hash_->add(value);
  }
  void hash(std::uint64_t value) noexcept {
    if (hashes()) hash_->add(value);
  }
  template <class AddTo>
  void hash_with(AddTo add_to) noexcept {
    if (hashes()) add_to(*hash_);
  }
  /// The first rows of columns, row by row.
  template <class... Columns>
  void hash_rows(std::size_t row_count, const Columns&... columns) noexcept {
    if (!hashes()) return;
    for (std::size_t i = 0; i < row_count; ++i) (add_to_hash(columns[i]), ...);
  }
  /// Some rows of columns, row by row.
  template <class Rows, class... Columns>
  void hash_rows_at(const Rows& rows, const Columns&... columns) noexcept {
    if (!hashes()) return;
    for (const auto row : rows) (add_to_hash(columns[row]), ...);
  }

 private:
  enum class Task : std::uint8_t { kSave, kMeasure, kCheck, kRestore, kHash };

  Archive(Task task, std::span<const double> row, std::vector<double>* saved, StateHash* hash)
      : task_(task), row_(row), saved_(saved), hash_(hash) {}

  bool reads() const noexcept { return task_ == Task::kCheck || task_ == Task::kRestore; }

  /// The next values of the row; none when there are fewer.
  std::span<const double> take(std::size_t value_count) noexcept {
    CORDIS_ASSERT(!restores() || value_count <= row_.size());
    if (value_count > row_.size()) {
      fits_ = false;
      row_ = {};
      return {};
    }
    const std::span<const double> taken = row_.first(value_count);
    row_ = row_.subspan(value_count);
    return taken;
  }

  /// True if the value is one of the type.
  template <class Value>
  static bool is_exact(double value) noexcept {
    if constexpr (std::floating_point<Value>) {
      return true;
    } else {
      constexpr std::uint64_t kExact = std::uint64_t{1} << 53;
      constexpr auto kMax =
          static_cast<double>(std::min<std::uint64_t>(kExact, std::numeric_limits<Value>::max()));
      return value >= 0.0 && value <= kMax &&
             value == static_cast<double>(static_cast<std::uint64_t>(value));
    }
  }

  /// True if the values at `next` are those of the types.
  template <class... Values>
  static bool are_exact(const double* next) noexcept {
    return (is_exact<Values>(*next++) && ...);
  }

  template <class Value>
  void add_to_hash(Value value) noexcept {
    if constexpr (std::floating_point<Value>) {
      hash_->add(value);
    } else {
      hash_->add(static_cast<std::uint64_t>(value));
    }
  }

  Task task_;
  std::span<const double> row_;  // that is still to be read
  std::vector<double>* saved_;   // of kSave
  StateHash* hash_;              // of kHash
  std::size_t size_ = 0;         // of kMeasure
  bool fits_ = true;
};

}  // namespace cordis::engine
