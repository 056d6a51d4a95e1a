// cli/check/check_report.cpp -- the report of `cordis check`, for a person and for a program.
#include "cli/check/check_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "node/config/count_text.h"
#include "sim_node/checks/settling.h"
#include "sim_node/checks/stability_check.h"

namespace cordis::cli {
namespace {

using scene::place_text;

std::string seconds(double value) {
  if (!std::isfinite(value)) return "any length";
  if (value < 1e-3) return fmt::format("{:.4g} us", 1e6 * value);
  return fmt::format("{:.4g} ms", 1e3 * value);
}

/// The place of a part, in brackets; nothing where there is none.
std::string location(const scene::Called& called) {
  return called.place.line > 0 ? " (" + place_text(called.place) + ")" : std::string();
}

std::string percent(double share) {
  return fmt::format("{:+.2g} %", 100.0 * share);
}

std::string limit_text(const SceneCheck& check) {
  const plan::StepBound& bound = check.plan.stability.certified;
  if (!std::isfinite(bound.step)) {
    return check.plan.stability.uncertainty ? "" : "limit       none: no step is too long\n";
  }
  const scene::Called liaison = scene::call_liaison(check.scene, bound.liaison);
  const scene::Called mat = scene::call_mat(check.scene, bound.mat);
  const engine::Mat& body = check.scene.network.mats[bound.mat];
  if (body.kind == engine::MatKind::kFixed) {
    return fmt::format("limit       set by {}{} at the fixed point {}{}\n", liaison.name,
                       location(liaison), mat.name, location(mat));
  }
  return fmt::format("limit       set by {}{} at the mass {} of {:.4g} kg{}\n", liaison.name,
                     location(liaison), mat.name, body.mass, location(mat));
}

/// True if no pose whatever has more partners than the step is certified for.
bool is_guaranteed(const plan::Stability& stability) {
  return std::all_of(stability.sets.begin(), stability.sets.end(),
                     [](const plan::PartnerLimit& set) { return set.is_guaranteed(); });
}

/// How many others a mass of a set may touch; nothing where geometry has no more.
std::string partners_text(const SceneCheck& check, const plan::PartnerLimit& set) {
  if (set.is_guaranteed()) return {};
  const scene::Called liaison =
      scene::call_liaison(check.scene, engine::LiaisonId{engine::LiaisonKind::kSet, set.set});
  const std::string sizes =
      set.least < set.most ? fmt::format(" (the largest of them {})", set.most) : std::string();
  return fmt::format(
      "            stable as long as no mass of {}{}\n            touches more than {} others at "
      "once{}; "
      "{} at the start; watched during the run\n",
      liaison.name, location(liaison), set.least, sizes, set.at_start);
}

/// What turns about, or the energy from which on something may.
std::string turning_text(const SceneCheck& check) {
  const plan::Turning& turning = check.plan.stability.turning;
  if (turning.liaison) {
    const scene::Called link = scene::call_liaison(check.scene, turning.liaison);
    if (check.scene.network.dimension == 1) {
      return fmt::format(
          "            the energy of the scene may press {}{} to length 0,\n"
          "            where its force turns about at once and motion without viscosity may gain\n"
          "            energy; energy is watched during the run\n",
          link.name, location(link));
    }
    return fmt::format(
        "            the energy of the scene may press {}{} by more than a\n"
        "            quarter of its length, where it turns about so fast that motion without "
        "viscosity\n            may gain energy; energy is watched during the run\n",
        link.name, location(link));
  }
  if (!std::isfinite(turning.energy)) return {};
  return fmt::format(
      "            beyond {:.3g} J links may turn about; energy is watched during the run\n",
      turning.energy);
}

/// What gains energy little by little at a certified step.
std::string bending_text(const SceneCheck& check) {
  const plan::Stability& stability = check.plan.stability;
  if (!stability.holds()) return {};
  const auto text_about = [&](const std::optional<plan::LiaisonId>& liaison,
                              fmt::string_view sentence) -> std::string {
    if (!liaison) return {};
    const scene::Called called = scene::call_liaison(check.scene, liaison);
    return fmt::format(fmt::runtime(sentence), called.name, location(called));
  };
  return text_about(stability.bending,
                    "            what passages over the bend of {}{} gain may add up without\n"
                    "            viscosity; energy is watched during the run\n") +
         text_about(stability.touching,
                    "            what touches of {}{} gain may add up, for its viscosity\n"
                    "            may take less; energy is watched during the run\n");
}

/// Where the step is surely unstable: from which rate on it is not.
std::string unstable_text(const SceneCheck& check) {
  const plan::Stability& stability = check.plan.stability;
  const double certain =
      check.plan.certain_step > 0.0 ? check.plan.certain_step : stability.certified.step;
  if (const double rate = sim::rate_above(check.scene, 1.0 / certain);
      rate <= scene::kHighestStepRate)
    return fmt::format("stability   UNSTABLE: take a rate_hz of {:.0f} or more\n", rate);
  const double uncertain = sim::rate_above(check.scene, 1.0 / stability.diverging_step);
  if (stability.uncertainty && uncertain <= scene::kHighestStepRate)
    return fmt::format(
        "stability   UNSTABLE: take a rate_hz of {:.0f} or more, none of which is certain\n",
        uncertain);
  return "stability   UNSTABLE at every rate_hz: take less stiffness or more mass\n";
}

/// A pair of a set takes more than the two fastest have only where many give theirs to it.
std::string pair_share_text(const SceneCheck& check) {
  const auto& share = check.plan.stability.pair_share;
  if (!share) return {};
  const scene::Called set =
      scene::call_liaison(check.scene, plan::LiaisonId{plan::LiaisonKind::kSet, share->set});
  return fmt::format(
      "            a pair of {} counts with {:.3g} J, of {:.3g} J in the scene; more in one "
      "pair is watched\n",
      set.name, share->energy, share->whole);
}

std::string stability_text(const SceneCheck& check) {
  const plan::Stability& stability = check.plan.stability;
  const double certain = check.plan.certain_step;
  const bool is_any_certain = certain > 0.0;
  std::string text;
  if (stability.holds()) {
    text = fmt::format(
        "stability   stable in every pose and state{}{}: margin {:.4g} % of stiffness\n",
        stability.turning.liaison ? " in which no link turns about" : "",
        is_guaranteed(stability) ? "" : " with the partners below", 100.0 * check.plan.margin());
  } else if (stability.diverges()) {
    text = unstable_text(check);
  } else if (stability.uncertainty) {
    text = fmt::format(
        "stability   not certain: {};\n            {}{}\n",
        sim::uncertainty_text(check.scene, *stability.uncertainty), sim::kWatchedText,
        is_any_certain && sim::rate_above(check.scene, 1.0 / certain) <= scene::kHighestStepRate
            ? fmt::format("; a rate_hz of {:.0f} is certain",
                          sim::rate_above(check.scene, 1.0 / certain))
            : "");
  } else {
    text = fmt::format(
        "stability   not certain: the scene may be unstable in some poses or states;\n"
        "            {}; a rate_hz of {:.0f} is stable in all{}\n",
        sim::kWatchedText, sim::rate_above(check.scene, 1.0 / stability.certified.step),
        stability.turning.liaison ? " in which no link turns about" : "");
  }
  text += fmt::format("            step {}", seconds(stability.step));
  if (is_any_certain) text += fmt::format("; certified up to {}", seconds(certain));
  text += std::isfinite(stability.diverging_step)
              ? fmt::format(", surely unstable beyond {}\n", seconds(stability.diverging_step))
              : "\n";
  if (!stability.bounded && !stability.uncertainty) {
    text += stability.laws_are_bounded ? "            a ball with enough energy passes a thin wall "
                                         "or a corner: certified for the "
                                         "\n            energy and speeds of the start, "
                                       : "            a law has no largest slope: certified for "
                                         "the energy and speeds of the start, "
                                         "\n            ";
    text += "and for a hand of 1 m/s;\n            beyond them energy is watched during the run\n";
    text += pair_share_text(check);
  }
  text += turning_text(check) + bending_text(check);
  if (!stability.uncertainty) {
    for (const plan::PartnerLimit& set : stability.sets) text += partners_text(check, set);
  }
  return text + limit_text(check);
}

std::string swing_text(double frequency_hz, const plan::OscillatorError& error) {
  return fmt::format("accuracy    at {:.4g} Hz: pitch {} ({:+.2g} cent), decay {} at most\n",
                     frequency_hz, percent(error.pitch), plan::cents(error.pitch),
                     percent(error.decay));
}

/// True if the errors leave out what signals of moving masses bring in.
bool leaves_signals_out(const SceneCheck& check) {
  const auto& uncertainty = check.plan.stability.uncertainty;
  return uncertainty && uncertainty->leaves_variables_free();
}

std::string band_edge_text(const plan::BandEdge& edge) {
  if (edge.error.creeps) {
    const std::string creep = percent(edge.error.creep);
    if (edge.swinging && edge.swinging->oscillates) {
      return swing_text(edge.frequency_hz, *edge.swinging) +
             fmt::format("            what its dampers let creep: {} at most\n", creep);
    }
    return fmt::format(
        "accuracy    at {:.4g} Hz the viscosity lets nothing swing: creep {} at most\n",
        edge.frequency_hz, creep);
  }
  if (!edge.error.oscillates) {
    return fmt::format("accuracy    at {:.4g} Hz nothing can swing at this rate and viscosity\n",
                       edge.frequency_hz);
  }
  return swing_text(edge.frequency_hz, edge.error);
}

std::string accuracy_text(const SceneCheck& check) {
  return band_edge_text(check.plan.band_edge) +
         (leaves_signals_out(check) ? "            without what the signals named above bring in\n"
                                    : "");
}

/// What the scene asks for, and what the plan does about it.
std::string choice_text(const SceneCheck& check) {
  if (!check.choice) return {};
  const scene::Accuracy& asked = *check.scene.accuracy;
  const plan::RateSelection& choice = *check.choice;
  std::string text = fmt::format(
      "asked       {:.4g} of {}, up to {:.4g} Hz; contacts {:.3g} %{}\n", asked.tolerance,
      asked.over_s > 0.0 ? fmt::format("the amplitude for {:.4g} s", asked.over_s)
                         : std::string("pitch and decay"),
      asked.band_hz, 100.0 * asked.contact_energy, location({"", asked.place}));
  if (check.keeps_accuracy()) {
    text += fmt::format("            {:.6g} Hz would do: because of {}", choice.needed_hz,
                        choice.because);
  } else {
    text += fmt::format(
        "            rate_hz is TOO LOW for that: {:.6g} Hz are needed, because of {}; it runs at "
        "{:.6g} Hz all the same",
        choice.needed_hz, choice.because, check.scene.step_rate_hz);
  }
  if (choice.error >= 0.0) text += fmt::format("; tried out: {:.2g}", choice.error);
  if (choice.worst_body) {
    text += fmt::format(
        "\n            what is joined to {} moves by itself with an error of {:.2g} of that",
        scene::call_mat(check.scene, choice.worst_body->mat).name, choice.worst_body->error);
  }
  if (!choice.uncertainty.empty()) text += "\n            " + choice.uncertainty;
  return text + "\n";
}

/// From here on bouncing without viscosity gained tenfold in 20,000 steps: K' = 0.2, docs/stability.md.
constexpr double kGainThatAddsUp = 0.05;

/// True if the force of a liaison may jump: as it changes its state, or by its law.
bool may_jump(const engine::NetworkDescription& network, plan::LiaisonId liaison) {
  const std::uint32_t machine = liaison.kind == plan::LiaisonKind::kSet
                                    ? network.sets[liaison.index].state_machine
                                    : network.state_links[liaison.index].state_machine;
  const std::vector<engine::LinkState>& states = network.state_machines[machine].states;
  const engine::Law& law = states.front().elasticity;
  const auto* power = std::get_if<engine::Power>(&law);
  const bool begins_at_0 = engine::is_none(law) || (power != nullptr && power->exponent >= 1.0);
  return states.size() > 1 || !begins_at_0;
}

std::string contact_text(const SceneCheck& check) {
  const auto& contact = check.plan.worst_contact;
  if (!contact) return {};
  const scene::Called liaison = scene::call_liaison(check.scene, contact->liaison);
  constexpr double kWhole = 0.995;  // from here on whole percent
  const double gain = 100.0 * contact->worst;
  const std::string share = contact->worst < kWhole ? fmt::format("{:.2g} % of its energy", gain)
                            : std::isfinite(gain)   ? fmt::format("{:.0f} % of its energy", gain)
                                                    : "energy without a bound";
  std::string text = fmt::format(
      "contacts    one collision gains {} at worst{}: {}{}{}\n", share,
      may_jump(check.scene.network, contact->liaison) ? ", more where its force jumps" : "",
      liaison.name, location(liaison),
      contact->is_several ? " with what else touches its mass" : "");
  if (contact->worst >= kGainThatAddsUp)
    text +=
        "            without viscosity what collisions gain adds up, in the end without a limit\n";
  return text;
}

std::string needs_text(const scene::PortNeeds& needs) {
  std::string text;
  const auto add = [&text](double needed, const char* what) {
    if (needed > 0.0) text += fmt::format("{}{:.4g} {}", text.empty() ? "" : " and ", needed, what);
  };
  add(needs.travel, "m of travel");
  add(needs.up, "m above its rest");
  add(needs.down, "m below its rest");
  add(needs.force, "N");
  if (text.empty()) return {};
  return "            needs a device of " + text + " along each of its axes\n";
}

std::string support_text(const sim::DeviceAtPort& device) {
  if (!device.supported_stiffness)
    return std::string("has no known viscosity or limit") +
           (device.is_supported ? "" : ", and lacks what the port needs");
  return fmt::format("supports {:.4g} N/m: {}", *device.supported_stiffness,
                     device.is_supported     ? "enough"
                     : device.needed_delay_s ? "enough once its answers are measured to be fast, "
                                               "see below"
                                             : "see below");
}

/// What is said of a port, without its name.
std::string port_text(const SceneCheck& check, const PortCheck& port) {
  const double rate = check.scene.gesture_rate_hz;
  const int delay_periods = port.delay_periods;
  const std::string delay = config::count_text(static_cast<std::size_t>(delay_periods), "period");
  const std::string of_viscosity =
      delay_periods == 0 ? std::string()
                         : fmt::format(" and as its own viscosity divided by {:.3g} ms",
                                       1e3 * delay_periods / rate);
  if (port.port->role == scene::Role::kLiaison) {
    return fmt::format("a hand may be as stiff as {:.4g} N/m{}, at {:.4g} Hz and {} of delay\n",
                       port.largest_hand_stiffness, of_viscosity, rate, delay) +
           needs_text(port.port->needs);
  }
  std::string text = fmt::format(
      "{:.4g} N/m and {:.3g} N s/m; with any hand safe from {:.3g} N s/m of the device "
      "on, at {:.4g} Hz and {} of delay\n",
      port.load.stiffness, port.load.viscosity, port.min_device_viscosity, rate, delay);
  for (const sim::DeviceAtPort& device : port.devices) {
    text += fmt::format("            the device of {} {}\n", device.node, support_text(device));
  }
  return text + needs_text(port.port->needs);
}

/// A paragraph for each port; one for those that follow each other and have the same.
std::string ports_text(const SceneCheck& check) {
  std::string text;
  for (std::size_t first = 0; first < check.ports.size();) {
    const scene::Port& port = *check.ports[first].port;
    const std::string place = place_text(port.place);
    const std::string what = port_text(check, check.ports[first]);
    std::size_t last = first + 1;
    while (last < check.ports.size() && place_text(check.ports[last].port->place) == place &&
           port_text(check, check.ports[last]) == what) {
      ++last;
    }
    const std::size_t count = last - first;
    const std::string who = count == 1 ? port.name
                                       : fmt::format("{} ports {} to {}", count, port.name,
                                                     check.ports[last - 1].port->name);
    text += fmt::format("port        {} ({}): {}", who, place, what);
    first = last;
  }
  return text;
}

/// The clock for a scene that has more time than the wall: simulated hands wait for it.
const char* slow_clock_of(const SceneCheck& check) {
  return check.scene.ports.empty() ? "asap" : "lockstep";
}

std::string load_text(const SceneCheck& check) {
  std::string text =
      fmt::format("load        {:.4g} us a step{}, {:.3g} % of real time on this machine\n",
                  1e-3 * check.step_nsec,
                  check.scene.network.freeze_tolerance > 0.0 ? " with all masses awake" : "",
                  100.0 * check.load());
  text +=
      fmt::format("            the longest of {} takes {:.4g} us\n",
                  config::count_text(check.measured_steps, "step"), 1e-3 * check.worst_step_nsec);
  if (check.load() < 1.0) {
    if (!check.makes_ticks_late()) return text;
    return text + fmt::format(
                      "            with it a tick takes longer than its period of {:.4g} ms: "
                      "some ticks come late\n",
                      1e3 / check.scene.gesture_rate_hz);
  }
  const double rate = check.real_time_rate();
  const bool stable = check.is_certified_at(rate);
  text += fmt::format(
      "            TOO SLOW for real time: run it with clock {}, {:.3g} times slower, or ",
      slow_clock_of(check), check.load());
  if (rate == 0.0) return text + "make it smaller: a step takes longer than a gesture\n";
  text += fmt::format("at {:.6g} steps per second{}\n", rate,
                      stable ? "" : ", which is unstable: make it smaller or softer");
  if (check.choice && stable) {
    text += fmt::format("            at that rate the tolerance would be about {:.2g}\n",
                        check.tolerance_at(rate));
  }
  return text;
}

/// Too slow for real time: what else there is.
nlohmann::json alternatives_json(const SceneCheck& check) {
  const double rate = check.real_time_rate();
  nlohmann::json real_time{{"rate_hz", rate}, {"stable", check.is_certified_at(rate)}};
  if (check.choice && rate > 0.0) real_time["tolerance"] = check.tolerance_at(rate);
  return {{slow_clock_of(check), {{"times_slower", check.load()}}},
          {"realtime", std::move(real_time)}};
}

nlohmann::json load_json(const SceneCheck& check) {
  nlohmann::json json{{"step_nsec", check.step_nsec},
                      {"worst_step_nsec", check.worst_step_nsec},
                      {"measured_steps", check.measured_steps},
                      {"makes_ticks_late", check.makes_ticks_late()},
                      {"share_of_real_time", check.load()}};
  if (check.load() >= 1.0) json["alternatives"] = alternatives_json(check);
  return json;
}

nlohmann::json finite(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

nlohmann::json reductions_json(const std::vector<scene::Reduction>& reductions) {
  nlohmann::json list = nlohmann::json::array();
  for (const scene::Reduction& reduction : reductions) {
    list.push_back(
        {{"name", reduction.name}, {"count", reduction.count}, {"what", reduction.what}});
  }
  return list;
}

nlohmann::json called(const scene::Called& called) {
  nlohmann::json json{{"name", called.name}};
  if (called.place.line > 0) {
    json["file"] = called.place.file;
    json["line"] = called.place.line;
  }
  return json;
}

nlohmann::json ports_json(const SceneCheck& check) {
  nlohmann::json ports = nlohmann::json::array();
  for (const PortCheck& port : check.ports) {
    nlohmann::json json{{"name", port.port->name},
                        {"device", port.port->device},
                        {"stiffness_n_per_m", port.load.stiffness},
                        {"viscosity_n_s_per_m", port.load.viscosity},
                        {"delay_periods", port.delay_periods}};
    if (port.port->role == scene::Role::kMass) {
      json["role"] = "mass";
      json["min_device_viscosity_n_s_per_m"] = port.min_device_viscosity;
    } else {
      json["role"] = "liaison";
      json["largest_hand_stiffness_n_per_m"] = port.largest_hand_stiffness;
    }
    for (const sim::DeviceAtPort& device : port.devices) {
      nlohmann::json one{{"node", device.node}, {"supported", device.is_supported}};
      if (device.supported_stiffness)
        one["largest_stiffness_n_per_m"] = *device.supported_stiffness;
      if (device.needed_delay_s) one["needed_answer_delay_s"] = *device.needed_delay_s;
      json["devices"].push_back(std::move(one));
    }
    const scene::PortNeeds& needs = port.port->needs;
    if (needs.travel > 0.0) json["needs"]["travel_m"] = needs.travel;
    if (needs.up > 0.0) json["needs"]["up_m"] = needs.up;
    if (needs.down > 0.0) json["needs"]["down_m"] = needs.down;
    if (needs.force > 0.0) json["needs"]["force_n"] = needs.force;
    ports.push_back(std::move(json));
  }
  return ports;
}

nlohmann::json problems_json(const std::vector<config::Problem>& problems) {
  nlohmann::json list = nlohmann::json::array();
  for (const config::Problem& problem : problems) {
    const bool is_error = problem.severity == config::Problem::Severity::kError;
    list.push_back({{"severity", is_error ? "error" : "warning"},
                    {"file", problem.place.file},
                    {"line", problem.place.line},
                    {"column", problem.place.column},
                    {"message", problem.message},
                    {"hint", problem.hint}});
  }
  return list;
}

// The largest error of positions by freezing, in tolerances: measured, docs/reductions.md.
constexpr double kLargestError = 20.0;

std::string freezing_text(double tolerance) {
  if (tolerance == 0.0) return {};
  return fmt::format(
      "frozen      what rests within {:.2g} m: at rest, positions off by at most {:.2g} m;\n"
      "            more while much moves or creeps slowly together\n",
      tolerance, kLargestError * tolerance);
}

nlohmann::json sets_json(const SceneCheck& check) {
  nlohmann::json sets = nlohmann::json::array();
  const plan::Stability& stability = check.plan.stability;
  for (const plan::PartnerLimit& set : stability.sets) {
    const bool is_certified = !stability.uncertainty && !set.is_guaranteed();
    const engine::LiaisonId liaison{engine::LiaisonKind::kSet, set.set};
    sets.push_back(
        {{"liaison", called(scene::call_liaison(check.scene, liaison))},
         {"partners_at_start", set.at_start},
         {"certified_partners", is_certified ? nlohmann::json(set.least) : nlohmann::json(nullptr)},
         {"guaranteed", set.is_guaranteed()}});
  }
  return sets;
}

const char* verdict(const plan::Stability& stability) {
  if (stability.holds()) return "stable";
  return stability.diverges() ? "unstable" : "not_certain";
}

/// What was taken out of a scene, in lines for a person.
std::string reductions_text(const std::vector<scene::Reduction>& reductions) {
  std::string text;
  for (const scene::Reduction& reduction : reductions) {
    text += fmt::format("reduced     {}: {}; exact to rounding\n", reduction.name, reduction.what);
  }
  return text.empty() ? "reduced     nothing\n" : text;
}

}  // namespace

std::string text_of(const SceneCheck& check) {
  const scene::Scene& scene = check.scene;
  std::string text =
      fmt::format("scene       {} ({}), {}\n", scene.name, scene.file, scene::size_text(scene));
  text += fmt::format("integrator  {} at {:.6g} Hz, 1 thread\n",
                      engine::to_string(scene.network.integrator), scene.step_rate_hz);
  text += reductions_text(check.scene.reductions);
  text += freezing_text(scene.network.freeze_tolerance);
  if (scene.settled) text += "settled     " + sim::settled_text(scene) + "\n";
  text += choice_text(check) + stability_text(check) + accuracy_text(check) + contact_text(check);
  text += ports_text(check);
  return check.measured_steps > 0 ? text + load_text(check) : text;
}

std::string json_of(const SceneCheck& check, const std::vector<config::Problem>& others) {
  std::vector<config::Problem> problems = check.problems.in_order();
  problems.insert(problems.end(), others.begin(), others.end());
  const plan::Stability& stability = check.plan.stability;
  const plan::BandEdge& edge = check.plan.band_edge;
  const plan::OscillatorError& swing = edge.swinging ? *edge.swinging : edge.error;
  nlohmann::json json{{"scene", check.scene.name},
                      {"file", check.scene.file},
                      {"integrator", engine::to_string(check.scene.network.integrator)},
                      {"rate_hz", check.scene.step_rate_hz},
                      {"threads", 1},
                      {"stability",
                       {{"verdict", verdict(stability)},
                        {"step_s", stability.step},
                        {"certified_step_s", finite(check.plan.certain_step)},
                        {"diverging_step_s", finite(stability.diverging_step)},
                        {"margin", finite(check.plan.margin())},
                        {"bounded_laws", stability.bounded},
                        {"turns_at_j", finite(stability.turning.energy)},
                        {"may_turn", stability.turning.liaison.has_value()},
                        {"sets", sets_json(check)}}},
                      {"accuracy",
                       {{"band_hz", edge.frequency_hz},
                        {"oscillates", swing.oscillates},
                        {"creeps", edge.error.creeps},
                        {"creep_error", edge.error.creep},
                        {"pitch_error", swing.pitch},
                        {"decay_error", swing.decay},
                        {"leaves_signals_out", leaves_signals_out(check)}}},
                      {"ports", ports_json(check)},
                      {"problems", problems_json(problems)},
                      {"reductions", reductions_json(check.scene.reductions)}};
  if (const auto& settled = check.scene.settled) {
    json["settled"] = {{"steps", settled->steps},
                       {"force_n", settled->force},
                       {"moved_m", settled->way},
                       {"mat", called(scene::call_mat(check.scene, settled->mat))}};
  }
  if (check.measured_steps > 0) json["load"] = load_json(check);
  const double tolerance = check.scene.network.freeze_tolerance;
  if (tolerance > 0.0) {
    json["freezing"] = {{"tolerance_m", tolerance}, {"largest_error_m", kLargestError * tolerance}};
  }
  if (std::isfinite(stability.certified.step)) {
    json["stability"]["limit"] = {
        {"liaison", called(scene::call_liaison(check.scene, stability.certified.liaison))},
        {"mat", called(scene::call_mat(check.scene, stability.certified.mat))}};
  }
  if (check.choice) {
    const scene::Accuracy& asked = *check.scene.accuracy;
    json["asked"] = {
        {"tolerance", asked.tolerance},           {"band_hz", asked.band_hz},
        {"contact_energy", asked.contact_energy}, {"over_s", asked.over_s},
        {"needed_hz", check.choice->needed_hz},   {"because", check.choice->because},
        {"kept", check.keeps_accuracy()},         {"uncertainty", check.choice->uncertainty}};
    if (check.choice->error >= 0.0) json["asked"]["tried_out_error"] = check.choice->error;
    if (const auto& worst = check.choice->worst_body) {
      json["asked"]["worst_body"] = {{"mat", called(scene::call_mat(check.scene, worst->mat))},
                                     {"error", finite(worst->error)}};
    }
  }
  if (check.plan.worst_contact) {
    json["worst_contact"] = {
        {"energy_gain", finite(check.plan.worst_contact->worst)},
        {"liaison", called(scene::call_liaison(check.scene, check.plan.worst_contact->liaison))}};
  }
  return json.dump(2) + "\n";
}

}  // namespace cordis::cli
