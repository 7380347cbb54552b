// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/h5/entries.hpp"
#include "common/units.hpp"

/// Results as columns: each quantity is declared once, beside the code that computes it, and what is made of results
/// (files, tables, envelopes, studies) are loops over the columns.
namespace fastjoint::columns {

/// Powers of length and force in a unit, or its text.
struct Dimension {
  double length = 0, force = 0;
  const char* text = nullptr;
};
inline constexpr Dimension ratio{}, length{1, 0}, force{0, 1}, stress{-2, 1}, stiffness{-1, 1}, energy{1, 1},
    intensity{-1.5, 1}, angle{0, 0, "deg"};
[[nodiscard]] std::string unit_of(const Dimension& dimension, const Units& units);

/// What a quantity has numbers of: things of a joint (shear planes, loads) or of one of its plates.
enum class Of { plane, load, disc, external, traction, friction_case, wave, contact, hole, point, tip, row, axis };

/// A quantity as an output of studies.
struct Output {
  const char* name;               ///< of its group in STUDY.h5
  const char* asked;              ///< word in "outputs" of STUDY.json
  const char* meaning;            ///< one sentence
  const char* largest = nullptr;  ///< meaning of the largest of all; none of a quantity whose sign counts, of which
                                  ///< several cases give that of the largest magnitude
  bool is_magnitude = false;      ///< without its sign, and of several parts the first
};

/// A quantity of a result.
struct Quantity {
  std::string path;  ///< in RESULT.h5, or within the group of its plate
  Dimension dimension;
  std::string meaning;     ///< one sentence
  std::string envelope{};  ///< name in the envelope of all cases; empty: it is not there
  h5::Allowed allowed{};
  std::optional<Output> output{};  ///< of studies
  bool needs_section = false;      ///< not known at a hole without sections, where the file has 0
};

/// Quantities whose numbers are computed together at one increment.
/// @tparam At What they are computed from: a joint, or one of its plates, at an increment that was solved.
template <class At>
struct Group {
  Of of;
  Eigen::Index n;  ///< how many things
  std::vector<Quantity> quantities;
  std::function<Eigen::MatrixXd(const At&)> values;  ///< (n parts, quantities), parts varying fastest
  std::optional<std::vector<std::string>> parts;     ///< names of the numbers of each; none: it has one
  h5::Shape extents{};                               ///< of the parts in the file; none: those of a list

  Group(Of its_things, Eigen::Index count, std::vector<Quantity> all, decltype(values) compute,
        decltype(parts) its_parts = {})
      : of(its_things), n(count), quantities(std::move(all)), values(std::move(compute)), parts(std::move(its_parts)) {}

  /// How many numbers each quantity has, and all have, at one increment.
  [[nodiscard]] Eigen::Index n_of_each() const { return n * (parts ? std::ssize(*parts) : 1); }
  [[nodiscard]] Eigen::Index n_numbers() const { return n_of_each() * std::ssize(quantities); }
};

/// The numbers of a quantity at every increment.
struct Column {
  Quantity quantity;
  Of of;
  Eigen::Index n;  ///< how many things
  std::optional<std::vector<std::string>> parts;
  Eigen::MatrixXd rows;  ///< (steps, n parts), parts varying fastest
  h5::Shape extents{};   ///< of the parts in the file; none: those of a list

  /// Extents in the file.
  [[nodiscard]] h5::Shape shape() const {
    h5::Shape all{rows.rows(), n};
    if (!extents.empty())
      all.insert(all.end(), extents.begin(), extents.end());
    else if (parts)
      all.push_back(std::ssize(*parts));
    return all;
  }
};

/// Columns of a joint or of one of its plates.
class Columns {
 public:
  Columns() = default;
  /// All quantities of groups at all increments.
  template <class At>
  Columns(const std::vector<Group<At>>& groups, const std::vector<At>& increments) {
    for (const auto& group : groups) add(group, increments);
  }
  /// Adds a column, in place of one with its path.
  void put(Column column);

  [[nodiscard]] auto begin() const { return all_.begin(); }
  [[nodiscard]] auto end() const { return all_.end(); }
  /// The column of a path; null without it.
  [[nodiscard]] const Column* find(const std::string& path) const;
  /// The rows of a column that must be there, (steps, n parts).
  [[nodiscard]] const Eigen::MatrixXd& operator[](const std::string& path) const;
  /// Adds later increments of the same things below. Columns that they do not have are dropped.
  void append(const Columns& later);

 private:
  template <class At>
  void add(const Group<At>& group, const std::vector<At>& increments) {
    const Eigen::Index steps = std::ssize(increments);
    const std::size_t first = all_.size();
    for (const auto& quantity : group.quantities)
      all_.push_back(
          {quantity, group.of, group.n, group.parts, Eigen::MatrixXd(steps, group.n_of_each()), group.extents});
    for (Eigen::Index step = 0; step < steps && !group.quantities.empty(); ++step) {
      const Eigen::MatrixXd values = group.values(increments[step]);
      for (std::size_t i = 0; i < group.quantities.size(); ++i)
        all_[first + i].rows.row(step) = values.col(Eigen::Index(i)).transpose();
    }
  }

  std::vector<Column> all_;
};

/// Writes all columns.
template <class Writer>
void write(Writer& file, const std::string& group, const Columns& columns, const Units& units) {
  for (const auto& each : columns)
    file(group + each.quantity.path, each.rows, each.shape(), unit_of(each.quantity.dimension, units),
         each.quantity.meaning, each.quantity.allowed);
}

}  // namespace fastjoint::columns
