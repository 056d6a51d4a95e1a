// idl/schema_table.h -- the files of the contract, as they are at build time.
#pragma once

#include <span>

#include "idl/schema_text.h"

namespace cordis::msg {

/// Every struct of idl/*.idl, each with the whole text of its file.
std::span<const SchemaText> schema_sources() noexcept;

}  // namespace cordis::msg
