// node/config/key_log.h -- what the readers of files ask of each key, for a schema of those files.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "node/config/number.h"
#include "node/config/problem.h"

namespace cordis::config {

/// What a reader takes for the value of a key.
enum class KeyKind {
  kAny,  ///< several kinds, or a text with rules of its own
  kNumber,
  kInteger,
  kIntegerOrWord,  ///< a whole number, or one of `choices`
  kTruth,
  kText,
  kChoice,    ///< one of `choices`
  kNumbers,   ///< a number, or a sequence of numbers
  kIntegers,  ///< a whole number, or a sequence of them
  kMapping,
  kSequence,
  kMappingOrWord,  ///< a mapping, or one of `choices`
  kFormula,        ///< a number, or a text that is a formula
  kColour,         ///< a name of CSS, or #rrggbb
  kVector,         ///< a number for each dimension of the scene; in 1-D a number alone will do
  kVectors,        ///< a vector, or a sequence of vectors
  kFormulaVector,  ///< a vector whose numbers may be formulas
  kFormulaVectors  ///< likewise, or a sequence of vectors of numbers
};

/// One question of a reader for one key. What does not belong to its kind is empty.
struct KeyRequest {
  std::string key;
  KeyKind kind = KeyKind::kAny;
  bool required = false;
  Range range{};                       ///< range of numbers, formulas and integers
  std::vector<std::string> choices{};  ///< allowed words of a choice
  std::size_t length = 0;              ///< length of a sequence of numbers; 0: any
  std::string fallback{};              ///< as a file would say it; empty: none
  Place mapping{};                     ///< where the mapping of the key stands
  /// It says all that its reader takes. What the same reader asks for the key besides adds nothing.
  bool is_whole = false;
  /// Keys of which each will do in place of this one, where it is required.
  std::vector<std::string> alternatives{};
};

/// While it lives, the MappingReaders of its thread record their requests in it. One at a time per
/// thread. Without one a reader does no work for it.
class KeyLog {
 public:
  KeyLog();
  ~KeyLog();
  KeyLog(const KeyLog&) = delete;
  KeyLog& operator=(const KeyLog&) = delete;

  /// The log of this thread; nullptr when there is none.
  static KeyLog* current() noexcept;

  void add(KeyRequest request) { requests_.push_back(std::move(request)); }
  /// In the order in which they were asked.
  const std::vector<KeyRequest>& requests() const noexcept { return requests_; }

 private:
  std::vector<KeyRequest> requests_;
};

}  // namespace cordis::config
