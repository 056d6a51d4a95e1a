// sim_node/engine/laws/law_kernel_body.h -- the value of any law for 8 rows at a time.
#pragma once

#include <cstddef>
#include <utility>

#include "sim_node/engine/expressions/program_kernel_body.h"
#include "sim_node/engine/laws/law.h"
#include "sim_node/engine/simd/lane_batch.h"

namespace cordis::engine {

template <class Lanes>
struct LawLoop {
  /// Adds the tension of the law to `tension`.
  static void add(const LawTerm& law, const LawArguments& arguments, double* tension) noexcept {
    if (law.type != 0)
      add_any(law, arguments, tension, std::make_index_sequence<std::variant_size_v<Law>>{});
  }

 private:
  template <std::size_t... kTypes>
  static void add_any(const LawTerm& law, const LawArguments& arguments, double* tension,
                      std::index_sequence<kTypes...> /*all*/) noexcept {
    static_cast<void>((add_if<kTypes>(law, arguments, tension) || ...));
  }

  template <std::size_t kType>
  static bool add_if(const LawTerm& law, const LawArguments& arguments, double* tension) noexcept {
    if (law.type != kType) return false;
    using Type = std::variant_alternative_t<kType, Law>;
    Type::template add<Lanes>(*static_cast<const typename Type::Term*>(law.term), arguments,
                              tension);
    return true;
  }
};

}  // namespace cordis::engine
