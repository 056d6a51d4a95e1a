// tests/schema/key_tables.h -- the meanings of keys, from the tables of the documents.
#pragma once

#include <map>
#include <string>

namespace cordis::test {

/// Meanings of keys by the heading above their table.
class KeyTables {
 public:
  /// Reads the tables of a document whose rows begin with `| `key` |`. The last column is the
  /// meaning; one headed `default` adds its text to it.
  explicit KeyTables(const std::string& file);

  /// The meaning without Markdown; empty when the table of no such heading has the key.
  std::string meaning(const std::string& heading, const std::string& key) const;

  const std::map<std::string, std::map<std::string, std::string>>& headings() const {
    return headings_;
  }

 private:
  std::map<std::string, std::map<std::string, std::string>> headings_;
};

/// The unit that the ending of a key says: "[N/m]" of stiffness_n_per_m; empty when it says none.
std::string unit_of(const std::string& key);

}  // namespace cordis::test
