// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/joined_result.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/count.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

template <class Rows>
void add_rows(Rows& all, const Rows& more) {
  const Index n = all.rows();
  if (more.rows() == 0) return;
  if (n == 0) {
    all = more;
    return;
  }
  all.conservativeResize(n + more.rows(), all.cols());
  all.bottomRows(more.rows()) = more;
}

template <class Item>
void add_items(std::vector<Item>& all, std::vector<Item>& more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

void add_stiffness(formats::JointResult& all, const formats::JointResult& its, Index n_before) {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  for (const auto& external : its.load_external)
    if (index_of(all.load_external, external) == count_of(all.load_external)) all.load_external.push_back(external);
  const Index before = all.load_stiffness.cols(), n = its.load_stiffness.rows();
  all.load_stiffness.conservativeResize(n_before + n, std::ssize(all.load_external));
  all.load_stiffness.rightCols(all.load_stiffness.cols() - before).setConstant(unknown);
  all.load_stiffness.bottomRows(n).setConstant(unknown);
  for (Index i = 0; i < std::ssize(its.load_external); ++i)
    all.load_stiffness.col(index_of(all.load_external, its.load_external[i])).tail(n) = its.load_stiffness.col(i);
}

void add_contacts(formats::ContactHistory& all, const formats::ContactHistory& its) {
  all.no_load_peak = all.no_load_peak.cwiseMax(its.no_load_peak);
  all.no_load_least = all.no_load_least.cwiseMax(its.no_load_least);
  all.full_until = all.full_until.cwiseMin(its.full_until);
  for (const auto table : {&formats::ContactHistory::touching, &formats::ContactHistory::from,
                           &formats::ContactHistory::to, &formats::ContactHistory::peak_pressure,
                           &formats::ContactHistory::peak_angle, &formats::ContactHistory::least_gap})
    add_rows(all.*table, its.*table);
}

void add_plate(formats::PlateHistory& all, formats::PlateHistory& its) {
  using formats::CrackHistory;
  using formats::PlateHistory;
  for (const auto table : {&PlateHistory::D, &PlateHistory::De, &PlateHistory::free_D, &PlateHistory::free_De,
                           &PlateHistory::Pe, &PlateHistory::amounts, &PlateHistory::w, &PlateHistory::Lambda,
                           &PlateHistory::traction, &PlateHistory::traction_displacement, &PlateHistory::applied,
                           &PlateHistory::by_fasteners, &PlateHistory::by_supports})
    add_rows(all.*table, its.*table);
  for (const auto table : {&formats::RowHistory::force, &formats::RowHistory::before, &formats::RowHistory::after})
    add_rows(all.rows.*table, its.rows.*table);
  add_rows(all.disc_forces->bearing, its.disc_forces->bearing);
  add_rows(all.disc_forces->friction, its.disc_forces->friction);
  add_contacts(all.contacts, its.contacts);
  for (const auto table :
       {&CrackHistory::K_I, &CrackHistory::K_II, &CrackHistory::K_I_error, &CrackHistory::K_II_error})
    add_rows(all.cracks.*table, its.cracks.*table);
  add_items(all.rims.values, its.rims.values);
  if (all.rims.stresses && its.rims.stresses) {
    auto &stresses = *all.rims.stresses, &more = *its.rims.stresses;
    if (stresses.angle.size() == 0) stresses.start = more.start, stresses.angle = more.angle;
    for (const auto table : {&formats::RimStresses::rr, &formats::RimStresses::tt, &formats::RimStresses::rt})
      add_rows(stresses.*table, more.*table);
  }
  using formats::NearStresses;
  if (all.rims.near && its.rims.near)
    for (const auto table : {&NearStresses::peak, &NearStresses::angle, &NearStresses::error, &NearStresses::rr,
                             &NearStresses::tt, &NearStresses::rt})
      add_rows((*all.rims.near).*table, (*its.rims.near).*table);
}

}  // namespace

void append(formats::JointResult& all, const std::string& case_name, formats::JointResult its) {
  using formats::JointResult;
  const int at = count_of(all.case_name);
  its.case_of = Eigen::VectorXi::Constant(its.load_factor.size(), at);
  if (at == 0) {
    all = std::move(its);
    all.case_name = {case_name};
    return;
  }
  all.case_name.push_back(case_name);
  add_stiffness(all, its, all.load_factor.size());
  all.complete &= its.complete;
  for (const auto list : {&JointResult::load_factor, &JointResult::residual}) add_rows(all.*list, its.*list);
  for (const auto list : {&JointResult::converged, &JointResult::iterations, &JointResult::case_of})
    add_rows(all.*list, its.*list);
  add_items(all.event, its.event);
  for (const auto table : {&JointResult::delta, &JointResult::F, &JointResult::delta_vector, &JointResult::F_vector,
                           &JointResult::transferred, &JointResult::set, &JointResult::dissipated})
    add_rows(all.*table, its.*table);
  if (all.F_error && its.F_error)
    add_rows(*all.F_error, *its.F_error);
  else
    all.F_error.reset();
  for (std::size_t i = 0; i < all.plates.size(); ++i) add_plate(all.plates[i], its.plates[i]);
}

}  // namespace fastjoint::stage3
