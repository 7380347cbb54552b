// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/envelope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "stage3_nonlinear/output/csv_field.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using formats::EnvelopeTable;
using formats::JointResult;

/// Tables of the envelope, filled with columns of numbers over all increments.
class Tables {
 public:
  explicit Tables(const JointResult& result) : n_steps_(result.load_factor.size()) {}

  /// Takes in the value at(step) of what is called `of`; not if it is unknown at every increment.
  template <class At>
  void add(const std::string& quantity, const std::string& unit, const std::string& of, At at) {
    Index largest = -1, smallest = -1;
    for (Index i = 0; i < n_steps_; ++i) {
      const double value = at(i);
      if (!std::isfinite(value)) continue;
      if (largest < 0 || value > at(largest)) largest = i;
      if (smallest < 0 || value < at(smallest)) smallest = i;
    }
    if (largest < 0) return;
    auto found = std::ranges::find(tables_, quantity, &EnvelopeTable::quantity);
    if (found == tables_.end()) found = tables_.insert(tables_.end(), {.quantity = quantity, .unit = unit});
    found->of.push_back(of);
    for (const auto& [list, value] :
         {std::pair(&found->largest, at(largest)), std::pair(&found->smallest, at(smallest))})
      list->conservativeResize(list->size() + 1), (*list)[list->size() - 1] = value;
    for (const auto& [list, row] : {std::pair(&found->largest_at, largest), std::pair(&found->smallest_at, smallest)})
      list->conservativeResize(list->size() + 1), (*list)[list->size() - 1] = int(row);
  }
  void add(const std::string& quantity, const std::string& unit, const std::string& of,
           const Eigen::Ref<const Eigen::VectorXd>& values) {
    add(quantity, unit, of, [&](Index i) { return values[i]; });
  }

  std::vector<EnvelopeTable> take() { return std::move(tables_); }

 private:
  Index n_steps_;
  std::vector<EnvelopeTable> tables_;
};

void add_plate(const formats::PlateHistory& plate, const Units& units, Tables& tables) {
  for (const auto& quantity : formats::rim_quantities())
    for (Index rim = 0; rim < std::ssize(plate.rims.hole); ++rim)
      if (!quantity.needs_section || plate.rims.sections[rim] > 0)
        tables.add(quantity.name, unit_of(quantity.dimension, units), plate.name + ":" + plate.rims.hole[rim],
                   [&](Index step) { return plate.rims.values[step][rim].*quantity.value; });
  for (Index rim = 0; rim < std::ssize(plate.contact); ++rim)
    tables.add("contact_pressure", unit(units, -2, 1), plate.name + ":" + plate.contact[rim].hole,
               plate.contacts.peak_pressure.col(rim));
  for (Index e = 0; e < std::ssize(plate.external_id); ++e) {
    const std::string name = plate.name + ":" + plate.external_id[e];
    tables.add("displacement", unit(units, 1, 0), name, plate.De.col(e));
    tables.add("external_force", unit(units, 0, 1), name, plate.Pe.col(e));
  }
  for (Index t = 0; t < std::ssize(plate.cracks.tip); ++t) {
    const std::string name = plate.name + ":" + plate.cracks.tip[t], K = unit(units, -1.5, 1);
    tables.add("K_I", K, name, plate.cracks.K_I.col(t));
    tables.add("K_II", K, name, plate.cracks.K_II.col(t));
  }
}

}  // namespace

std::vector<EnvelopeTable> envelope(const JointModel& joint, const JointResult& a) {
  const Units& units = a.header.units;
  const std::string force = unit(units, 0, 1);
  Tables tables(a);
  for (Index j = 0; j < a.F.cols(); ++j) {
    const std::string plane = joint.short_name(joint.planes[j]);
    tables.add("transferred_first", force, plane, a.transferred.col(2 * j));
    tables.add("transferred_second", force, plane, a.transferred.col(2 * j + 1));
    tables.add("F", force, plane, a.F.col(j));
    const Index n = std::ssize(a.direction);
    for (Index d = 0; n > 1 && d < n; ++d) tables.add("F_" + a.direction[d], force, plane, a.F_vector.col(j * n + d));
    tables.add("delta", unit(units, 1, 0), plane, a.delta.col(j));
  }
  for (const auto& plate : a.plates) add_plate(plate, units, tables);
  return tables.take();
}

Index increment_number(const JointResult& a, Index row) {
  return 1 + (a.case_of.head(row).array() == a.case_of[row]).count();
}

std::string increment_of(const JointResult& a, Index row) {
  const std::string text = fmt::format("increment {}", increment_number(a, row)), &name = a.case_name[a.case_of[row]];
  return name.empty() ? text : fmt::format("{} of case \"{}\"", text, name);
}

std::string envelope_csv(const JointResult& a) {
  std::string text =
      "joint,quantity,of,unit,largest,largest in case,at increment,smallest,smallest in case,at increment\n";
  for (const auto& table : a.envelope)
    for (Index i = 0; i < std::ssize(table.of); ++i) {
      text += fmt::format("{},{},{},{}", csv_field(a.header.name), table.quantity, csv_field(table.of[i]),
                          csv_field(table.unit));
      for (const auto& [value, row] :
           {std::pair(table.largest[i], table.largest_at[i]), std::pair(table.smallest[i], table.smallest_at[i])})
        text += fmt::format(",{},{},{}", value, csv_field(a.case_name[a.case_of[row]]), increment_number(a, row));
      text += "\n";
    }
  return text;
}

}  // namespace fastjoint::stage3
