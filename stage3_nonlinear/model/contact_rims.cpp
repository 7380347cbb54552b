// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/contact_rims.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <vector>

#include "common/rim/rim_compliance.hpp"

namespace fastjoint::stage3 {
namespace {

/// Entries of the loaded waves in the file's rows, by rim: pressures, then shears.
struct FileRows {
  std::vector<Index> pressures, shears;
  VectorXd area_of_pressure, area_of_shear, modulus;  ///< of each
};

FileRows file_rows(const formats::PlateMatrices& a) {
  FileRows rows;
  Index next = 0;
  std::vector<double> area_p, area_s, modulus;
  for (Index i = 0; i < std::ssize(a.contact); ++i) {
    const auto& rim = a.waves[i];
    for (Index k = 0; k < rim.waves.size(); ++k, ++next) {
      rows.pressures.push_back(next);
      area_p.push_back(rim.area);
      modulus.push_back(rim.modulus);
    }
    for (Index k = 0; k < rim.waves.n_shears(); ++k, ++next) {
      rows.shears.push_back(next);
      area_s.push_back(rim.area);
    }
  }
  const auto vector = [](const std::vector<double>& list) -> VectorXd {
    return Eigen::Map<const VectorXd>(list.data(), std::ssize(list));
  };
  rows.area_of_pressure = vector(area_p);
  rows.area_of_shear = vector(area_s);
  rows.modulus = vector(modulus);
  return rows;
}

/// Places of the long and of the short waves of all rims among all of their waves.
struct Places {
  std::vector<Index> long_p, short_p, long_s, short_s;
  Index n_p = 0, n_s = 0;
};

void add_places(const ShortWaves& rim, Places& places) {
  for (Index k = 0; k < rim.n; ++k) (k < rim.n_long ? places.long_p : places.short_p).push_back(places.n_p++);
  for (Index k = 0; k < rim.n_shears; ++k)
    (k < rim.n_long_shears ? places.long_s : places.short_s).push_back(places.n_s++);
}

/// Puts the matrix of each rim on the diagonal.
MatrixXd diagonal_of(const std::vector<ShortWaves>& rims, MatrixXd ShortWaves::*block, Index rows, Index cols) {
  MatrixXd all = MatrixXd::Zero(rows, cols);
  Index row = 0, col = 0;
  for (const auto& rim : rims) {
    const MatrixXd& its = rim.*block;
    all.block(row, col, its.rows(), its.cols()) = its;
    row += its.rows();
    col += its.cols();
  }
  return all;
}

}  // namespace

ShortWaves short_waves(const formats::ContactRim& contact, const formats::WaveRim& carried) {
  const auto& [full, long_waves] = std::tie(contact.pressures, carried.waves);
  ShortWaves a{
      long_waves.size(), full.size(), long_waves.n_shears(), full.n_shears(), {}, full, {}, {}, {}, {}, {}, {}};
  const Index s = a.n - a.n_long, s_t = a.n_shears - a.n_long_shears;
  for (auto& [matrix, rows, cols] :
       {std::tuple(&a.G, s, a.n_long), std::tuple(&a.C, s, s), std::tuple(&a.G_t, s, a.n_long_shears),
        std::tuple(&a.C_t, s, s_t), std::tuple(&a.E, a.n_long, s_t)})
    *matrix = MatrixXd::Zero(rows, cols);
  if (!carried.has_closed_form()) return a;
  const rim::RimCompliance sheet(carried.compliance, carried.radius);
  a.D = sheet.displacements(full);
  a.wider.highest = std::min(2 * full.highest, rim::most_harmonics);
  a.D_beyond = sheet.displacements(a.wider).middleRows(a.n, a.wider.size() - a.n);
  if (s == 0) return a;
  const MatrixXd nn = a.D.topLeftCorner(a.n, a.n), nt = a.D.topRightCorner(a.n, a.n_shears);
  const MatrixXd softened = MatrixXd::Identity(s, s) + contact.modulus * nn.bottomRightCorner(s, s);
  const Eigen::PartialPivLU<MatrixXd> lu(softened);
  a.G = lu.solve(nn.bottomLeftCorner(s, a.n_long));
  a.C = lu.solve(nn.bottomRightCorner(s, s));
  a.G_t = lu.solve(nt.bottomLeftCorner(s, a.n_long_shears));
  a.C_t = lu.solve(nt.bottomRightCorner(s, s_t));
  a.E = nt.topRightCorner(a.n_long, s_t) - contact.modulus * a.G.transpose() * nt.bottomRightCorner(s, s_t);
  return a;
}

RimMatrices rim_matrices(const formats::PlateMatrices& a, Index level) {
  const FileRows rows = file_rows(a);
  const Index e = a.n_externals(), m = a.n_discs(), h = a.n_friction_cases(), q = a.n_tractions();
  std::vector<ShortWaves> rims;
  Places at;
  for (Index i = 0; i < std::ssize(a.contact); ++i)
    add_places(rims.emplace_back(short_waves(a.contact[i], a.waves[i])), at);
  const Index n_long = std::ssize(at.long_p), n_short = std::ssize(at.short_p), n_long_s = std::ssize(at.long_s),
              n_short_s = std::ssize(at.short_s);
  // Displacements in means over the rim, tractions as stresses; forces at the end.
  const auto mean = rows.area_of_pressure.cwiseInverse().asDiagonal();
  const auto& W = a.W[level];
  const auto wave_columns = [&](const std::vector<Index>& list) {
    std::vector<Index> columns;
    for (const Index k : list) columns.push_back(e + m + k);
    return columns;
  };
  MatrixXd by_u(n_long, m + e);
  by_u << W(rows.pressures, Eigen::seqN(e, m)), W(rows.pressures, Eigen::seqN(0, e));
  const MatrixXd B = mean * by_u, C = -(mean * W(rows.pressures, wave_columns(rows.pressures))),
                 R_p = mean * W(rows.pressures, wave_columns(rows.shears)),
                 R_f = mean * W(rows.pressures, Eigen::lastN(h + q)).leftCols(h),
                 T = mean * W(rows.pressures, Eigen::lastN(q));
  MatrixXd R(m + e, n_long_s);
  R << W(rows.shears, Eigen::seqN(e, m)).transpose(), W(rows.shears, Eigen::seqN(0, e)).transpose();
  VectorXd area_p(at.n_p);
  Index next_p = 0;
  for (Index i = 0; i < std::ssize(rims); ++i) {
    area_p.segment(next_p, rims[i].n).setConstant(a.contact[i].area);
    next_p += rims[i].n;
  }
  const MatrixXd G = diagonal_of(rims, &ShortWaves::G, n_short, n_long),
                 E = diagonal_of(rims, &ShortWaves::E, n_long, n_short_s);
  const MatrixXd GK = G * rows.modulus.asDiagonal();
  const MatrixXd Y = MatrixXd::Identity(n_long, n_long) - C * rows.modulus.asDiagonal();
  RimMatrices all{MatrixXd(at.n_p, m + e),  MatrixXd(at.n_p, at.n_p), MatrixXd(m + e, at.n_s),
                  MatrixXd(at.n_p, at.n_s), MatrixXd(at.n_p, h),      MatrixXd(at.n_p, q)};
  all.B(at.long_p, Eigen::all) = B;
  all.B(at.short_p, Eigen::all) = -GK * B;
  all.C(at.long_p, at.long_p) = C;
  all.C(at.long_p, at.short_p) = Y * G.transpose();
  all.C(at.short_p, at.long_p) = (Y * G.transpose()).transpose();
  all.C(at.short_p, at.short_p) = diagonal_of(rims, &ShortWaves::C, n_short, n_short) - GK * Y * G.transpose();
  all.R(Eigen::all, at.long_s) = R;
  all.R(Eigen::all, at.short_s) = -(B.transpose() * rows.area_of_pressure.cwiseProduct(rows.modulus).asDiagonal() * E);
  all.R_p(at.long_p, at.long_s) = R_p;
  all.R_p(at.long_p, at.short_s) = -Y * E;
  all.R_p(at.short_p, at.long_s) = -GK * R_p - diagonal_of(rims, &ShortWaves::G_t, n_short, n_long_s);
  all.R_p(at.short_p, at.short_s) = GK * Y * E - diagonal_of(rims, &ShortWaves::C_t, n_short, n_short_s);
  all.R_f(at.long_p, Eigen::all) = R_f;
  all.R_f(at.short_p, Eigen::all) = -GK * R_f;
  all.T(at.long_p, Eigen::all) = T;
  all.T(at.short_p, Eigen::all) = -GK * T;
  all.C = (all.C * area_p.cwiseInverse().asDiagonal()).eval();
  return all;
}

}  // namespace fastjoint::stage3
