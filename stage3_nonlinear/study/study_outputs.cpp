// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/study_outputs.hpp"

#include <algorithm>
#include <cmath>

#include "stage3_nonlinear/results/joint_quantities.hpp"

namespace fastjoint::stage3 {

std::vector<columns::Output> all_outputs() {
  std::vector<columns::Output> outputs;
  const auto add = [&](const auto& groups) {
    for (const auto& group : groups)
      for (const auto& quantity : group.quantities)
        if (quantity.output) outputs.push_back(*quantity.output);
  };
  add(plane_quantities({}));
  PlateModel plate;
  plate.bends = true;
  add(plate_quantities(plate));
  return outputs;
}

template <class At, class Names>
void StudyOutputs::add(const std::vector<columns::Group<At>>& groups, Index plate, const StudyScene& study,
                       Names names) {
  for (Index at = 0; at < std::ssize(groups); ++at) {
    const auto& group = groups[at];
    const Index parts = group.parts ? std::ssize(*group.parts) : 1;
    for (Index column = 0; column < std::ssize(group.quantities); ++column) {
      const columns::Quantity& quantity = group.quantities[column];
      const auto& output = quantity.output;
      if (!output || !study.outputs.contains(output->asked) || group.n == 0) continue;
      Source source{plate, at, column, 0, {}, 0};
      std::vector<std::string> of;
      const std::vector<std::string> all = names(group.of);
      for (Index i = 0; i < group.n; ++i)
        if (!all[i].empty()) of.push_back(all[i]), source.rows.push_back(i * parts);
      if (of.empty()) continue;
      const auto is_it = [&](const OutputKind& each) { return each.output.name == std::string(output->name); };
      auto kind = std::ranges::find_if(kinds_, is_it);
      if (kind == kinds_.end()) kind = kinds_.insert(kind, {*output, quantity.dimension});
      source.kind = kind - kinds_.begin(), source.first = std::ssize(kind->of);
      kind->of.insert(kind->of.end(), of.begin(), of.end());
      const auto limit = study.limits.find(output->name);
      kind->limit.resize(kind->of.size(), limit == study.limits.end() ? infinite : limit->second);
      sources_.push_back(std::move(source));
    }
  }
}

StudyOutputs::StudyOutputs(const JointModel& joint, const Parameters& parameters, const JointScene& scene,
                           const StudyScene& study)
    : of_joint_(plane_quantities(joint)) {
  std::vector<std::string> planes;
  for (const auto& plane : joint.planes) planes.push_back(joint.short_name(plane));
  add(of_joint_, -1, study, [&](columns::Of) { return planes; });
  for (Index j = 0; j < joint.n_planes(); ++j)
    if (const auto limit = study.fastener_limits.find(joint.fasteners[joint.planes[j].fastener].id);
        limit != study.fastener_limits.end())
      kinds_[0].limit[j] = limit->second;
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    const formats::PlateHistory things = things_of(plate);
    of_plates_.push_back(plate_quantities(plate));
    add(of_plates_.back(), i, study, [&](columns::Of of) {
      auto names = things.names(of);
      for (auto& name : names)
        if (of == columns::Of::hole && !plate.has_peak(name))
          name.clear();  // not known
        else
          name.insert(0, plate.name + ":");
      return names;
    });
  }
  if (study.outputs.contains("margins")) add_checks(joint, parameters, scene, study);
  for (auto& kind : kinds_) kind.first = size_, size_ += std::ssize(kind.of);
}

void StudyOutputs::add_checks(const JointModel& joint, const Parameters& parameters, const JointScene& scene,
                              const StudyScene& study) {
  OutputKind kind{
      {"utilisation", "margins", "FS FF applied / allowable of each check; its margin is 1 over this less 1",
       "largest FS FF applied / allowable of all"},
      columns::ratio};
  CheckedItems checked = checked_items(scene, joint, parameters);
  left_out_ = checked.left_out;
  const auto counts = [&](const CheckScene& check) {
    return study.cases.empty() || std::ranges::any_of(study.cases, [&](const auto& its) { return check.counts(its); });
  };
  for (auto& item : checked.items) {
    const bool is_solved = counts(*item.check);
    if (!item.is_known || !is_solved) {
      left_out_.add(*item.check, is_solved ? item.unknown : "the study has none of its cases", item.of);
      continue;
    }
    kind.of.push_back(item.check->name + ": " + item.of);
    const auto least = study.least_margins.find(item.check->name);
    kind.limit.push_back(least == study.least_margins.end() ? 1 : 1 / (1 + least->second));
    items_.push_back(std::move(item));
  }
  if (items_.empty()) return;
  kinds_.push_back(std::move(kind));
  for (const auto& plate : of_plates_) {
    const auto is_checked = [](const PlateGroup& its) {
      return its.of == columns::Of::hole || its.of == columns::Of::disc;
    };
    std::ranges::copy_if(plate, std::back_inserter(checked_.emplace_back()), is_checked);
  }
}

VectorXd StudyOutputs::utilisations(const JointAt& at, const std::string& case_name) const {
  const columns::Columns joint(of_joint_, std::vector<JointAt>{at});
  std::vector<columns::Columns> plates;
  for (Index i = 0; i < std::ssize(checked_); ++i) plates.emplace_back(checked_[i], std::vector<PlateAt>{{at, i}});
  JointColumns columns{&joint, {}};
  for (const auto& each : plates) columns.plates.push_back(&each);
  VectorXd all = VectorXd::Zero(std::ssize(items_));
  for (Index i = 0; i < all.size(); ++i) {
    const CheckedItem& item = items_[i];
    if (!item.check->counts(case_name)) continue;
    const Applied its = item.at(columns, 0);
    all[i] = std::isfinite(its.applied) ? 1 / (1 + item.margin(its)) : infinite;
  }
  return all;
}

VectorXd StudyOutputs::numbers(const JointAt& at, const std::string& case_name) const {
  VectorXd all(size_);
  MatrixXd values;
  const Source* before = nullptr;  // of the same group
  for (const Source& source : sources_) {
    if (before == nullptr || before->plate != source.plate || before->group != source.group)
      values = source.plate < 0 ? of_joint_[source.group].values(at)
                                : of_plates_[source.plate][source.group].values({at, source.plate});
    before = &source;
    const OutputKind& kind = kinds_[source.kind];
    for (Index i = 0; i < std::ssize(source.rows); ++i) {
      const double value = values(source.rows[i], source.column);
      all[kind.first + source.first + i] = kind.output.is_magnitude ? std::abs(value) : value;
    }
  }
  if (!items_.empty()) all.tail(std::ssize(items_)) = utilisations(at, case_name);
  return all;
}

bool StudyOutputs::need_stresses() const {
  const auto is_of_hole = [&](const Source& its) {
    return its.plate >= 0 && of_plates_[its.plate][its.group].of == columns::Of::hole;
  };
  return !items_.empty() || std::ranges::any_of(sources_, is_of_hole);
}

bool StudyOutputs::need_bending() const {
  const auto is_checked = [](const CheckedItem& item) { return item.check->with_bending; };
  return std::ranges::count(kinds_, std::string_view("bending"),
                            [](const auto& its) { return std::string_view(its.output.asked); }) > 0 ||
         std::ranges::any_of(items_, is_checked);
}

void StudyOutputs::take(const VectorXd& its, VectorXd& all) const {
  for (const auto& kind : kinds_)
    for (Index i = kind.first; i < kind.first + std::ssize(kind.of); ++i) {
      const bool has_sign = kind.output.largest == nullptr;
      if (has_sign ? std::abs(its[i]) > std::abs(all[i]) : its[i] > all[i]) all[i] = its[i];
    }
}

}  // namespace fastjoint::stage3
