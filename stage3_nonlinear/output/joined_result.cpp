// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/joined_result.hpp"

#include <algorithm>
#include <utility>

#include "common/count.hpp"
#include "common/infinite.hpp"

namespace fastjoint::stage3 {

using Eigen::Index, Eigen::MatrixXd;

namespace {

template <class Rows>
void add_rows(Rows& all, const Rows& more) {
  all.conservativeResize(all.size() + more.size());
  all.tail(more.size()) = more;
}

/// Gives a result columns for these loads, infinite for those that it does not have.
void spread_loads(const std::vector<std::string>& loads, formats::JointResult& a) {
  columns::Column column = *a.columns.find("stiffness/tangent");
  MatrixXd rows = MatrixXd::Constant(a.load_factor.size(), std::ssize(loads), infinite);
  for (Index i = 0; i < std::ssize(a.load_external); ++i)
    rows.col(index_of(loads, a.load_external[i])) = column.rows.col(i);
  column.n = rows.cols(), column.rows = std::move(rows);
  a.columns.put(std::move(column));
  a.load_external = loads;
}

void add_plate(formats::PlateHistory& all, const formats::PlateHistory& its) {
  auto& before = all.at_no_load;
  before.peak = before.peak.cwiseMax(its.at_no_load.peak);
  before.least = before.least.cwiseMax(its.at_no_load.least);
  before.full_until = before.full_until.cwiseMin(its.at_no_load.full_until);
  if (all.holes.angle.size() == 0) all.holes.start = its.holes.start, all.holes.angle = its.holes.angle;
  all.columns.append(its.columns);
}

}  // namespace

void append(formats::JointResult& all, const std::string& case_name, formats::JointResult its) {
  its.case_of = Eigen::VectorXi::Constant(its.load_factor.size(), count_of(all.case_name));
  all.case_name.push_back(case_name);
  if (all.case_name.size() == 1) {
    its.case_name = std::move(all.case_name);
    all = std::move(its);
    return;
  }
  std::vector<std::string> loads = all.load_external;
  for (const auto& each : its.load_external)
    if (index_of(loads, each) == count_of(loads)) loads.push_back(each);
  spread_loads(loads, all), spread_loads(loads, its);
  all.complete &= its.complete;
  add_rows(all.load_factor, its.load_factor), add_rows(all.residual, its.residual);
  add_rows(all.converged, its.converged), add_rows(all.iterations, its.iterations);
  add_rows(all.case_of, its.case_of);
  all.event.insert(all.event.end(), its.event.begin(), its.event.end());
  all.columns.append(its.columns);
  for (std::size_t i = 0; i < all.plates.size(); ++i) add_plate(all.plates[i], its.plates[i]);
}

}  // namespace fastjoint::stage3
