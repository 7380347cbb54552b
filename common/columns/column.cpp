// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/columns/column.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace fastjoint::columns {

std::string unit_of(const Dimension& dimension, const Units& units) {
  return dimension.text ? dimension.text : unit(units, dimension.length, dimension.force);
}

const Column* Columns::find(const std::string& path) const {
  const auto found = std::ranges::find(
      all_, path, [](const Column& each) -> const auto& { return each.quantity.path; });
  return found == all_.end() ? nullptr : &*found;
}

void Columns::put(Column column) {
  std::erase_if(all_, [&](const Column& each) { return each.quantity.path == column.quantity.path; });
  all_.push_back(std::move(column));
}

const Eigen::MatrixXd& Columns::operator[](const std::string& path) const {
  if (const Column* found = find(path)) return found->rows;
  throw std::out_of_range("no column " + path);
}

void Columns::append(const Columns& later) {
  std::erase_if(all_, [&](const Column& each) { return later.find(each.quantity.path) == nullptr; });
  for (auto& each : all_) {
    const Column& its = *later.find(each.quantity.path);
    const Eigen::Index before = each.rows.rows(), more = its.rows.rows();
    if (before == 0) each = its;
    if (before == 0 || more == 0) continue;
    each.rows.conservativeResize(before + more, Eigen::NoChange);
    each.rows.bottomRows(more) = its.rows;
  }
}

}  // namespace fastjoint::columns
