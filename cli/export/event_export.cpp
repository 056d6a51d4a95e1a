// cli/export/event_export.cpp
#include "cli/export/event_export.h"

#include "cli/export/event_table.h"
#include "cli/export/time_window.h"
#include "idl/topics.h"
#include "node/config/count_text.h"

namespace cordis::cli {
namespace {

/// string[3], or the name alone where it has one; `none` where no name stands for the index.
std::string name_in(const std::vector<msg::NamedRange>& ranges, std::uint32_t index,
                    const std::string& none) {
  for (const msg::NamedRange& range : ranges) {
    if (index < range.first() || index - range.first() >= range.count()) continue;
    return range.count() == 1 ? range.name()
                              : range.name() + "[" + std::to_string(index - range.first()) + "]";
  }
  return none;
}

std::string mat_name(const msg::SceneDescription& scene, std::uint32_t mat) {
  return name_in(scene.matter(), mat, "MAT " + std::to_string(mat));
}

/// The contract has its quantities in the order of the engine, but for those added later.
engine::Quantity quantity_of(msg::EventQuantity quantity) {
  if (quantity == msg::QUANTITY_SLID) return engine::Quantity::kSlid;
  if (quantity == msg::QUANTITY_NONE) return engine::Quantity::kNone;
  if (quantity >= msg::QUANTITY_ANGLE && quantity <= msg::QUANTITY_REST_ANGLE)
    return static_cast<engine::Quantity>(static_cast<int>(engine::Quantity::kAngle) +
                                         (quantity - msg::QUANTITY_ANGLE));
  return static_cast<engine::Quantity>(quantity);
}

EventRow row_of(const msg::LinkEvent& event, const msg::SceneDescription& scene) {
  EventRow row;
  row.time_s = static_cast<double>(event.step()) / scene.step_rate_hz();
  row.step = event.step();
  if (event.link() != msg::NO_INDEX) row.link = name_in(scene.links(), event.link(), "");
  row.mat_a = mat_name(scene, event.mat_a());
  row.mat_b = mat_name(scene, event.mat_b());
  row.quantity = quantity_word(quantity_of(event.quantity()));
  row.value = event.value();
  row.energy_j = event.energy_j();
  if (event.state_machine() >= scene.state_machines().size()) return row;
  const msg::StateMachineDescription& machine = scene.state_machines()[event.state_machine()];
  row.liaison = machine.name();
  if (event.from_state() < machine.states().size()) row.from = machine.states()[event.from_state()];
  if (event.to_state() < machine.states().size()) row.to = machine.states()[event.to_state()];
  return row;
}

}  // namespace

void export_events(const mcap::Reader& take, const TakeScene& scene, const ExportOptions& options,
                   ReadLoss& loss, ExportResult& result) {
  EventTable table(options.events_file);
  const TimeWindow window(options.start_s, options.duration_s, scene.description.step_rate_hz());
  MessageSource<msg::SceneEvents> source(take, msg::TOPIC_EVENTS, loss);
  msg::SceneEvents batch;
  std::uint64_t newest = 0;
  std::uint64_t missing = 0;
  std::uint64_t lost = 0;
  while (source.next(batch)) {
    if (batch.epoch() != scene.description.epoch() || batch.batch() <= newest) continue;
    const std::uint64_t skipped = batch.batch() - newest - 1;
    newest = batch.batch();
    if (!scene.has(batch)) continue;
    missing += skipped;
    lost += batch.lost();
    for (const msg::LinkEvent& event : batch.event()) {
      if (window.has(event.step())) table.write(row_of(event, scene.description));
    }
  }
  table.finish();
  result.event_count = table.count();
  if (missing > 0)
    result.losses.push_back("the take lacks " + config::count_text(missing, "batch", "batches") +
                            " of events");
  if (lost > 0)
    result.losses.push_back(config::count_text(lost, "event") +
                            " came too many at once: sim_node had no room");
}

}  // namespace cordis::cli
