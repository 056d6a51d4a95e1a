// cli/export/event_table.cpp
#include "cli/export/event_table.h"

#include "cli/table/csv_file.h"

namespace cordis::cli {

std::string quantity_word(engine::Quantity quantity) {
  for (const scene::QuantityName& known : scene::kQuantityNames) {
    if (known.quantity == quantity) return known.word;
  }
  for (const scene::QuantityName& known : scene::kBendQuantityNames) {
    if (known.quantity == quantity) return known.word;
  }
  return "";
}

EventTable::EventTable(const std::string& path) : file_(path) {
  file_.write("time [s],step,liaison,link,mat_a,mat_b,from,to,quantity,value,energy [J]\n");
}

void EventTable::write(const EventRow& row) {
  line_.clear();
  append_number(line_, row.time_s);
  line_ += ',';
  line_ += std::to_string(row.step);
  for (const std::string* text :
       {&row.liaison, &row.link, &row.mat_a, &row.mat_b, &row.from, &row.to, &row.quantity}) {
    line_ += ',';
    append_text(line_, *text);
  }
  for (const double value : {row.value, row.energy_j}) {
    line_ += ',';
    append_number(line_, value);
  }
  line_ += '\n';
  file_.write(line_);
  ++count_;
}

}  // namespace cordis::cli
