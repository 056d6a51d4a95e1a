// node/terminal_text.h -- texts of others on a terminal: their escape codes have no effect.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace cordis::node {

/// The text with '?' in place of what acts on a terminal. These are control characters but newline
/// and tab (ESC, CR, the C1 set of U+0080 to U+009F). They are also marks that turn the direction
/// of text, and bytes that are no UTF-8.
std::string terminal_text(std::string_view text);

/// terminal_text() with '?' in place of newlines and tabs as well: one line.
std::string terminal_line(std::string_view text);

/// Writes terminal_text(). Whatever comes from a file, a message or another process is printed with
/// this.
void print_text(std::FILE* stream, std::string_view text);

}  // namespace cordis::node
