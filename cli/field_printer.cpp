// cli/field_printer.cpp
#include "cli/field_printer.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "record_node/idl/message_decoder.h"

namespace cordis::cli {
namespace {

using record::FieldSink;

/// The shortest text that reads back as the number.
std::string number_text(double value, bool is_single) {
  return is_single ? fmt::format("{}", static_cast<float>(value)) : fmt::format("{}", value);
}

std::string json_text(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

class JsonSink final : public FieldSink {
 public:
  std::string text_made;

  void begin_struct() override { open('{'); }
  void member(std::string_view name) override {
    separate();
    text_made += json_text(name) + ":";
    is_first_ = true;  // no comma before the value
  }
  void end_struct() override { close('}'); }
  void begin_list(std::size_t) override { open('['); }
  void end_list() override { close(']'); }
  void truth(bool value) override { put(value ? "true" : "false"); }
  void integer(std::int64_t value) override { put(std::to_string(value)); }
  void natural(std::uint64_t value) override { put(std::to_string(value)); }
  void real(double value, bool is_single) override {
    put(std::isfinite(value) ? number_text(value, is_single) : "null");
  }
  void text(std::string_view value) override { put(json_text(value)); }
  void word(std::string_view word, std::int64_t value) override {
    put(word.empty() ? std::to_string(value) : json_text(word));
  }

 private:
  void separate() {
    if (!is_first_) text_made += ',';
    is_first_ = false;
  }
  void put(const std::string& value) {
    separate();
    text_made += value;
  }
  void open(char bracket) {
    separate();
    text_made += bracket;
    is_first_ = true;
  }
  void close(char bracket) {
    text_made += bracket;
    is_first_ = false;
  }

  bool is_first_ = true;
};

class CsvSink final : public FieldSink {
 public:
  FieldCells cells;

  void begin_struct() override {
    begin_value();
    names_.emplace_back();
  }
  void member(std::string_view name) override { names_.back() = name; }
  void end_struct() override { names_.pop_back(); }
  void begin_list(std::size_t) override {
    begin_value();
    names_.emplace_back("[");
    indices_.push_back(0);
  }
  void end_list() override {
    names_.pop_back();
    indices_.pop_back();
  }
  void truth(bool value) override { put(value ? "1" : "0"); }
  void integer(std::int64_t value) override { put(std::to_string(value)); }
  void natural(std::uint64_t value) override { put(std::to_string(value)); }
  void real(double value, bool is_single) override { put(number_text(value, is_single)); }
  void text(std::string_view value) override { put(quoted(value)); }
  void word(std::string_view word, std::int64_t value) override {
    put(word.empty() ? std::to_string(value) : std::string(word));
  }

 private:
  static std::string quoted(std::string_view text) {
    if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
    std::string cell = "\"";
    for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
    return cell + "\"";
  }
  /// A value that is an element of a list gets the next number of it.
  void begin_value() {
    if (names_.empty() || !names_.back().starts_with("[")) return;
    names_.back() = fmt::format("[{}]", indices_.back()++);
  }
  void put(const std::string& value) {
    begin_value();
    std::string name;
    for (const std::string& part : names_)
      name += (name.empty() || part.starts_with("[") ? "" : ".") + part;
    cells.names += (cells.names.empty() ? "" : ",") + name;
    cells.values += (is_first_ ? "" : ",") + value;
    is_first_ = false;
  }

  std::vector<std::string> names_;
  std::vector<std::size_t> indices_;
  bool is_first_ = true;
};

/// Lays a parsed JSON text out as YAML: it holds what JsonSink made, so nothing is lost.
class YamlText {
 public:
  explicit YamlText(std::size_t max_listed) : max_listed_(max_listed) {}

  std::string text(const nlohmann::ordered_json& value) {
    put_members(value, 2);
    return std::move(text_);
  }

 private:
  static bool is_flat(const nlohmann::ordered_json& list) {
    for (const auto& item : list) {
      if (item.is_structured()) return false;
    }
    return true;
  }
  bool is_shown(std::size_t index) const { return max_listed_ == 0 || index < max_listed_; }

  void put_members(const nlohmann::ordered_json& value, std::size_t indent) {
    for (const auto& [name, member] : value.items()) {
      text_ += std::string(indent, ' ') + name + ":";
      put_value(member, indent);
    }
  }
  void put_value(const nlohmann::ordered_json& value, std::size_t indent) {
    if (value.is_object()) {
      text_ += '\n';
      put_members(value, indent + 2);
    } else if (value.is_array() && !value.empty() && !is_flat(value)) {
      text_ += '\n';
      for (std::size_t i = 0; i < value.size() && is_shown(i); ++i) put_item(value[i], indent + 2);
      put_rest(value.size(), indent + 2);
    } else if (value.is_array()) {
      text_ += " [";
      for (std::size_t i = 0; i < value.size() && is_shown(i); ++i)
        text_ += (i == 0 ? "" : ", ") + value[i].dump();
      text_ += "]";
      put_rest(value.size(), 1);
      if (text_.back() != '\n') text_ += '\n';
    } else {
      text_ += " " + value.dump() + "\n";
    }
  }
  void put_item(const nlohmann::ordered_json& item, std::size_t indent) {
    text_ += std::string(indent, ' ') + "-";
    if (!item.is_object()) return put_value(item, indent);
    text_ += '\n';
    put_members(item, indent + 2);
  }
  void put_rest(std::size_t count, std::size_t indent) {
    if (is_shown(count - (count > 0 ? 1 : 0))) return;
    text_ += std::string(indent, ' ') + fmt::format("# {} in all, --full shows them\n", count);
  }

  std::size_t max_listed_;
  std::string text_;
};

}  // namespace

std::string json_of(const record::MessageType& type, std::span<const std::uint8_t> message) {
  JsonSink sink;
  record::decode(type, message, sink);
  return std::move(sink.text_made);
}

std::string yaml_of(const record::MessageType& type, std::span<const std::uint8_t> message,
                    std::size_t max_listed) {
  return YamlText(max_listed).text(nlohmann::ordered_json::parse(json_of(type, message)));
}

FieldCells csv_of(const record::MessageType& type, std::span<const std::uint8_t> message) {
  CsvSink sink;
  record::decode(type, message, sink);
  return std::move(sink.cells);
}

}  // namespace cordis::cli
