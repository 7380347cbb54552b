// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/study_outputs.hpp"

#include <algorithm>
#include <cmath>

#include "stage3_nonlinear/results/crack_errors.hpp"
#include "stage3_nonlinear/results/hole_quantities.hpp"
#include "stage3_nonlinear/results/joint_quantities.hpp"

namespace fastjoint::stage3 {

template <class At, class Name>
void StudyOutputs::add(columns::Group<At> group, Index plate, const StudyScene& study, Name name,
                       std::vector<Asked<At>>& all) {
  Asked<At> asked{std::move(group), plate, {}};
  const Index parts = asked.group.parts ? std::ssize(*asked.group.parts) : 1;
  for (Index column = 0; column < std::ssize(asked.group.quantities); ++column) {
    const columns::Quantity& quantity = asked.group.quantities[column];
    const auto& output = quantity.output;
    if (!output || !study.outputs.contains(output->asked)) continue;
    std::vector<std::string> names;
    std::vector<Index> rows;
    for (Index i = 0; i < asked.group.n; ++i)
      if (const std::string its = name(asked.group.of, i); !its.empty())
        names.push_back(its), rows.push_back(i * parts);
    if (names.empty()) continue;
    const auto is_it = [&](const OutputKind& each) { return each.output.name == std::string(output->name); };
    auto kind = std::ranges::find_if(kinds_, is_it);
    if (kind == kinds_.end()) kind = kinds_.insert(kind, {*output, quantity.dimension});
    asked.sources.push_back({column, kind - kinds_.begin(), rows, std::ssize(kind->of), output->is_magnitude});
    const auto limit = study.limits.find(output->name);
    kind->of.insert(kind->of.end(), names.begin(), names.end());
    kind->limit.resize(kind->of.size(), limit == study.limits.end() ? infinite : limit->second);
  }
  if (!asked.sources.empty()) all.push_back(std::move(asked));
}

StudyOutputs::StudyOutputs(const JointModel& joint, const JointScene& scene, const StudyScene& study) {
  for (auto& group : plane_quantities(joint))
    add(
        std::move(group), 0, study, [&](columns::Of, Index i) { return joint.short_name(joint.planes[i]); }, of_joint_);
  for (Index j = 0; j < joint.n_planes() && !study.fastener_limits.empty(); ++j) {
    const auto limit = study.fastener_limits.find(joint.fasteners[joint.planes[j].fastener].id);
    if (limit != study.fastener_limits.end()) kinds_[0].limit[j] = limit->second;
  }
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    const auto name = [&](columns::Of of, Index at) {
      const auto& all = of == columns::Of::hole  ? plate.stresses.rim_hole
                        : of == columns::Of::tip ? plate.cracks.tip
                                                 : plate.externals;
      return of == columns::Of::hole && !plate.has_peak(all[at]) ? "" : plate.name + ":" + all[at];
    };
    std::vector<PlateGroup> groups{hole_quantities(plate)};
    for (auto& group : displacement_quantities(plate)) groups.push_back(std::move(group));
    groups.push_back(crack_quantities(plate));
    for (auto& group : groups) add(std::move(group), i, study, name, of_plates_);
  }
  if (study.outputs.contains("margins")) add_checks(joint, scene, study);
  for (auto& kind : kinds_) kind.first = size_, size_ += std::ssize(kind.of);
}

void StudyOutputs::add_checks(const JointModel& joint, const JointScene& scene, const StudyScene& study) {
  OutputKind kind{
      {"utilisation", "margins", "FS FF applied / allowable of each check; its margin is 1 over this less 1",
       "largest FS FF applied / allowable of all"},
      columns::ratio};
  for (auto& item : checked_items(scene, joint).items) {
    if (!item.is_known) continue;
    kind.of.push_back(item.check->name + ": " + item.of);
    const auto least = study.least_margins.find(item.check->name);
    kind.limit.push_back(least == study.least_margins.end() ? 1 : 1 / (1 + least->second));
    items_.push_back(std::move(item));
  }
  if (!items_.empty()) kinds_.push_back(std::move(kind));
}

VectorXd StudyOutputs::utilisations(const JointAt& at, const std::string& case_name) const {
  const std::vector<JointAt> now{at};
  const columns::Columns joint(plane_quantities(at.joint), now);
  std::vector<columns::Columns> plates;
  for (Index i = 0; i < std::ssize(at.joint.plates); ++i) {
    std::vector<PlateGroup> groups{hole_quantities(at.joint.plates[i])};
    for (auto& group : displacement_quantities(at.joint.plates[i])) groups.push_back(std::move(group));
    plates.emplace_back(groups, std::vector<PlateAt>{{at, i}});
  }
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
  const auto put = [&](const auto& asked, const MatrixXd& values) {
    for (const auto& [column, kind, rows, first, is_magnitude] : asked.sources)
      for (Index i = 0; i < std::ssize(rows); ++i) {
        const double value = values(rows[i], column);
        all[kinds_[kind].first + first + i] = is_magnitude ? std::abs(value) : value;
      }
  };
  for (const auto& asked : of_joint_) put(asked, asked.group.values(at));
  for (const auto& asked : of_plates_) put(asked, asked.group.values({at, asked.plate}));
  if (!items_.empty()) all.tail(std::ssize(items_)) = utilisations(at, case_name);
  return all;
}

void StudyOutputs::take(const VectorXd& its, VectorXd& all) const {
  for (const auto& kind : kinds_)
    for (Index i = kind.first; i < kind.first + std::ssize(kind.of); ++i) {
      const bool has_sign = kind.output.largest == nullptr;
      if (has_sign ? std::abs(its[i]) > std::abs(all[i]) : its[i] > all[i]) all[i] = its[i];
    }
}

}  // namespace fastjoint::stage3
