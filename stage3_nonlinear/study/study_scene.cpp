// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/study_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "stage3_nonlinear/study/study_outputs.hpp"

namespace fastjoint::stage3 {
namespace {

using input::Value;
using nlohmann::json;

constexpr std::uint64_t max_study_samples = 1000000000;

/// A place in JOINT.json.
struct Found {
  std::string pointer;
  std::string words;    ///< names that its wildcards stand for: the id of a fastener, the name of a law
  std::string counted;  ///< id of the item that it gives by its index
  bool is_new = false;  ///< true if the joint has no number there yet
};

/// Follows the parts of a pointer from the k-th on. The last may be a key that an object does not have yet.
void look_up(const json& at, const std::vector<std::string>& parts, std::size_t k, const Found& so_far,
             std::vector<Found>& found) {
  if (k == parts.size()) {
    if (at.is_number()) found.push_back(so_far);
    return;
  }
  if (!at.is_structured()) return;
  const bool any = parts[k] == "*";
  const auto next = [&](const std::string& key) {
    Found its = so_far;
    its.pointer += (json::json_pointer() / key).to_string();
    return its;
  };
  bool is_there = false;
  for (const auto& [key, member] : at.items()) {
    if (!any && key != parts[k]) continue;
    is_there = true;
    Found its = next(key);
    const bool has_id = member.is_object() && member.contains("id") && member["id"].is_string();
    const std::string id = has_id ? member["id"].get<std::string>() : key;
    if (any) its.words += (its.words.empty() ? "" : " ") + id;
    if (!any && has_id) its.counted = id;
    look_up(member, parts, k + 1, its, found);
  }
  if (any || is_there || k + 1 < parts.size() || !at.is_object()) return;
  found.push_back(next(parts[k]));
  found.back().is_new = true;
}

std::vector<Found> places_of(const Value& place, const json& joint) {
  constexpr const char* allowed =
      "JSON pointers to numbers of laws, fasteners or loads, such as \"/laws/NAME/k\", \"/fasteners/*/clearance\", "
      "\"/loads/0/force\" or \"/cases/0/loads/0/force\"";
  const std::string text = place.text();
  const std::set<std::string> varied{"laws", "fasteners", "loads", "cases"};
  std::vector<std::string> parts;
  try {
    parts = parts_of_pointer(text);
  } catch (const json::parse_error&) {
    place.not_allowed(allowed);
  }
  if (parts.size() < 3 || !varied.contains(parts[0]) ||
      (parts[0] == "cases" && (parts.size() < 5 || parts[2] != "loads")))
    place.not_allowed(allowed);
  std::vector<Found> found;
  look_up(joint, parts, 0, {}, found);
  if (found.empty())
    place.fail(fmt::format("\"{}\" leads to no number of the joint", text),
               fmt::format("{}; lists count from 0, whatever the ids; cells of a table of cases do not vary", allowed));
  return found;
}

/// Reads one of the words of an enumeration, which stand in the order of its values.
template <class Choice>
Choice read_choice(const Value& value, const std::vector<std::string>& words) {
  return static_cast<Choice>(index_of(words, value.choice(words)));
}

void read_variable(const Value& value, const json& joint, std::vector<Variable>& variables) {
  value.only({"name", "at", "each", "use", "values", "grid", "table", "distribution"});
  Variable variable;
  variable.where = fmt::format("{}: {}", value.file(), value.pointer());
  const Value at = value.at("at");
  std::vector<Found> found;
  for (const auto& place : at.is_array() ? at.items(1) : std::vector{at})
    for (auto& each : places_of(place, joint)) found.push_back(std::move(each));
  std::set<std::string> places;
  for (const auto& place : found)
    if (!places.insert(place.pointer).second)
      at.fail(fmt::format("\"{}\" stands twice", place.pointer), "each place once");
  if (const auto use = value.find("use")) variable.use = read_choice<Use>(*use, {"value", "factor", "offset"});
  const auto name = value.find("name");
  variable.name = name ? name->text() : found.front().pointer;
  read_numbers(value, variable);
  const auto each = value.find("each");
  const bool each_alone = each && each->boolean();
  if (!each_alone) variables.push_back(variable);
  for (const auto& place : found) {
    if (each_alone) variables.push_back(variable);
    Variable& its = variables.back();
    its.places.push_back(place.pointer);
    if (!place.counted.empty())
      its.remarks.push_back(fmt::format("{} is of \"{}\"{}", place.pointer, place.counted,
                                        place.is_new ? ", for which the joint itself gives none" : ""));
    if (each_alone)
      its.name = !name ? place.pointer : variable.name + " " + (place.words.empty() ? place.pointer : place.words);
  }
}

void check_places(const StudyScene& study, const json& joint) {
  std::set<std::string> places, names;
  for (const auto& variable : study.variables) {
    if (!names.insert(variable.name).second)
      throw InputError(
          fmt::format("{}/name: \"{}\" stands twice; allowed: each name once", variable.where, variable.name));
    for (const auto& place : variable.places) {
      if (!places.insert(place).second)
        throw InputError(
            fmt::format("{}/at: \"{}\" is varied already; allowed: each place once", variable.where, place));
      if (variable.use != Use::value && !joint.contains(json::json_pointer(place)))
        throw InputError(fmt::format("{}/at: the joint has no number at \"{}\" to change; allowed: \"use\": \"value\"",
                                     variable.where, place));
    }
  }
}

Sampling read_sampling(const Value& root, const StudyScene& study) {
  const bool all_levels =
      std::ranges::all_of(study.variables, [](const auto& its) { return !its.listed.empty() && its.table.empty(); });
  if (const auto given = root.find("sampling")) {
    const auto sampling = read_choice<Sampling>(*given, sampling_names);
    if (sampling == Sampling::grid && !all_levels)
      given->fail("\"grid\", but not all variables have levels", "\"values\" or \"grid\" for every variable");
    return sampling;
  }
  return all_levels ? Sampling::grid : Sampling::random;
}

/// Sets the number of samples.
void read_number(const Value& root, StudyScene& study) {
  const auto given = root.find("samples");
  if (study.sampling == Sampling::grid) {
    if (given) given->fail("given for a grid", "no \"samples\": a grid has as many as its levels make");
    study.n_samples = 1;
    for (const auto& variable : study.variables) {
      study.n_samples *= variable.listed.size();
      if (study.n_samples > max_study_samples)
        root.at("variables").fail("a grid of too many samples", fmt::format("up to {}", max_study_samples));
    }
    return;
  }
  constexpr auto unlimited = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t rows = unlimited;
  for (const auto& variable : study.variables)
    if (!variable.table.empty()) rows = std::min<std::uint64_t>(rows, variable.listed.size());
  study.n_samples = given || rows == unlimited ? root.at("samples").integer(1, int(max_study_samples)) : rows;
  if (study.n_samples > rows)
    given->fail(fmt::format("{}", study.n_samples), fmt::format("up to the {} rows of the table", rows));
}

/// Limits of the loads of fasteners, each by its id.
void read_force_limits(const Value& limit, const Value& joint, StudyScene& study) {
  std::vector<std::string> ids;
  for (const auto& fastener : joint.at("fasteners").items()) ids.push_back(fastener.at("id").text());
  for (const auto& [id, of_one] : limit.members()) {
    if (std::ranges::find(ids, id) == ids.end()) of_one.fail("no fastener", fmt::format("{}", fmt::join(ids, ", ")));
    study.fastener_limits[id] = of_one.number(input::positive);
  }
}

/// Limits of outputs, and least margins of checks by their names.
void read_limits(const Value& limits, const Value& joint, StudyScene& study) {
  std::vector<std::string> allowed, asked;  // names of limits, and words for what they are limits of
  for (const auto& output : all_outputs())
    if (output.largest != nullptr) allowed.emplace_back(output.name), asked.emplace_back(output.asked);
  if (const auto margins = joint.find("margins"))
    for (const auto& check : margins->at("checks").items())
      allowed.push_back(check.find("name").value_or(check.at("check")).text());
  for (const auto& [name, limit] : limits.members()) {
    const auto at = std::size_t(index_of(allowed, name));
    if (at == allowed.size()) limit.fail("unknown key", fmt::format("{}", fmt::join(allowed, ", ")));
    const bool is_margin = at >= asked.size();
    if (is_margin)
      study.least_margins[name] = limit.number(input::not_negative);
    else if (limit.is_object() && name == "force")
      read_force_limits(limit, joint, study);
    else
      study.limits[name] = limit.number(input::positive);
    study.outputs.insert(is_margin ? "margins" : asked[at]);
  }
}

}  // namespace

std::vector<std::string> parts_of_pointer(const std::string& pointer) {
  std::vector<std::string> parts;
  for (json::json_pointer rest(pointer); !rest.empty(); rest.pop_back()) parts.insert(parts.begin(), rest.back());
  return parts;
}

StudyScene read_study_scene(const input::Document& document, const input::Document& joint) {
  const Value root(document);
  input::check_format(root, "study");
  root.only({"$schema", "format", "version", "name", "samples", "seed", "sampling", "variables", "outputs", "limits",
             "cases"});
  StudyScene study;
  study.file = document.file;
  study.text = document.text;
  if (const auto name = root.find("name")) study.name = name->text();
  for (const auto& variable : root.at("variables").items(1)) read_variable(variable, *joint.root, study.variables);
  check_places(study, *joint.root);
  study.sampling = read_sampling(root, study);
  read_number(root, study);
  if (const auto seed = root.find("seed")) study.seed = seed->integer(0, std::numeric_limits<int>::max());
  std::vector<std::string> words;
  for (const auto& output : all_outputs())
    if (words.empty() || words.back() != output.asked) words.emplace_back(output.asked);
  words.emplace_back("margins");
  if (const auto outputs = root.find("outputs"))
    for (const auto& output : outputs->items()) study.outputs.insert(output.choice(words));
  const auto fasteners = joint.root->find("fasteners");
  if (fasteners != joint.root->end() && fasteners->is_array() && fasteners->empty())
    study.outputs.insert("peaks");  // sheets alone have no forces, which are kept of others
  if (const auto cases = root.find("cases"))
    for (const auto& name : cases->items(1)) {
      if (std::ranges::find(study.cases, name.text()) != study.cases.end())
        name.fail(fmt::format("\"{}\" stands twice", name.text()), "each case once");
      study.cases.push_back(name.text());
    }
  if (const auto limits = root.find("limits")) read_limits(*limits, Value(joint), study);
  return study;
}

std::vector<double> sample_values(const StudyScene& study, std::uint64_t seed, std::uint64_t sample) {
  std::vector<double> values(study.variables.size());
  std::uint64_t rest = sample;
  for (std::size_t i = study.variables.size(); i-- > 0;) {  // in a grid the last variable changes fastest
    const Variable& variable = study.variables[i];
    if (!variable.table.empty()) {
      values[i] = variable.listed[sample];
    } else if (study.sampling == Sampling::grid) {
      values[i] = variable.listed[rest % variable.listed.size()];
      rest /= variable.listed.size();
    } else {
      double fraction = random_fraction(seed, sample, i);
      if (study.sampling == Sampling::latin_hypercube)
        fraction = (double(random_place(seed, sample, i, study.n_samples)) + fraction) / double(study.n_samples);
      values[i] = variable.distribution->at(std::clamp(fraction, 1e-300, 1 - 1e-16));
    }
  }
  return values;
}

std::vector<double> middle_values(const StudyScene& study) {
  std::vector<double> values;
  for (const auto& variable : study.variables) values.push_back(middle_of(variable));
  return values;
}

}  // namespace fastjoint::stage3
