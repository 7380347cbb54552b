// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>

#include "common/errors.hpp"
#include "common/formats/joint_result.hpp"
#include "common/formats/plate_matrices.hpp"
#include "common/h5/writer.hpp"
#include "tests/support/files.hpp"
#include "tests/support/result.hpp"

namespace fastjoint::formats {
namespace {

using h5::any;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Names = std::vector<std::string>;

TEST(Units, AreWrittenAsEngineersDo) {
  const Units units{"in", "lbf"};
  EXPECT_EQ(unit(units, 1, 0), "in");
  EXPECT_EQ(unit(units, 2, 0), "in^2");
  EXPECT_EQ(unit(units, -1, 1), "lbf/in");
  EXPECT_EQ(unit(units, -3, 1), "lbf/in^3");
  EXPECT_EQ(unit(units, 1, -1), "in/lbf");
  EXPECT_EQ(unit(units, 1, 1), "lbf in");
  EXPECT_EQ(unit(units, -1, 0), "1/in");
  EXPECT_EQ(unit(units, 0, 0), "1");
  EXPECT_EQ(unit({}, -1, 1), "force/length");
  EXPECT_EQ(unit({"in", "lbf"}, -0.7, 1), "lbf/in^0.7");
}

/// MATRICES.h5 as a laboratory would write it: only what must be there, and what a test adds.
class HandMade : public testing::Test {
 protected:
  using Add = std::function<void(h5::Writer&)>;
  void write(
      const Add& add = [](auto&) {}, const std::vector<int>& p = {1}, const char* unit = "") const {
    h5::Writer file(path_, {"plate-matrices", 1, 0});
    file("p", p, {any}, "1", "");
    file("disc/hole", Names{"a", "b"}, {any}, "1", "");
    file("disc/direction", Names{"x", "x"}, {any}, "1", "");
    file("S_dd", std::vector<Eigen::Matrix2d>(p.size(), Eigen::Matrix2d::Identity()), {any, 2, 2}, unit, "");
    add(file);
    file.commit();
  }
  [[nodiscard]] PlateMatrices read() const { return read_plate_matrices(path_); }
  void refused(const std::string& message) const {
    EXPECT_THAT([&] { (void)read(); }, ThrowsMessage<FileError>(HasSubstr("lab.h5" + message)));
  }

 private:
  test::TemporaryFolder folder_;
  std::string path_ = folder_.path("lab.h5");
};

TEST_F(HandMade, FilesMayLeaveOutWhatTheyDoNotHave) {
  write();
  const PlateMatrices a = read();
  EXPECT_EQ(a.n_discs(), 2);
  EXPECT_EQ(a.n_externals() + a.n_friction_cases() + a.n_tractions(), 0);
  EXPECT_EQ(a.S_dd.at(0), Eigen::MatrixXd::Identity(2, 2));
  EXPECT_EQ(a.R_df.at(0).rows(), 2);
  EXPECT_EQ(a.disc_modulus, Eigen::VectorXd::Zero(2));
  EXPECT_EQ(a.ndof, Eigen::VectorXi::Zero(1));
  EXPECT_TRUE(std::isinf(a.S_dd_error(0, 0)));
  EXPECT_EQ(a.stresses.p.size() + a.stresses.section_hole.size(), 0);
}

TEST_F(HandMade, AnExternalNeedsItsStiffness) {
  const auto external = [](h5::Writer& file) { file("external/id", Names{"P"}, {any}, "", ""); };
  write(external);
  refused(":S_ee: dataset is missing");
  write([&](h5::Writer& file) {
    external(file);
    file("S_ee", Eigen::Matrix<double, 1, 1>(3), {1, 1, 1}, "", "");
    file("S_ed", Eigen::Vector2d(0, -1), {1, 1, 2}, "", "");
  });
  EXPECT_EQ(read().external_direction, Names{"x"});
  EXPECT_EQ(read().S_ed.at(0), Eigen::RowVector2d(0, -1));
}

TEST_F(HandMade, EveryFrictionCaseHasASide) {
  const auto write_with = [&](const Names& bearing) {
    write([&](h5::Writer& file) {
      file("friction/hole", Names{"a", "a"}, {any}, "", "");
      if (!bearing.empty()) file("friction/bearing", bearing, {any}, "", "");
    });
  };
  write_with({});
  refused(":friction/bearing: dataset is missing");
  write_with({"+x", "x"});
  refused(":friction/bearing: holds \"x\", expected one of +x, -x, +y, -y");
  write_with({"+x", "-x"});
  refused(":friction/unit_force: dataset is missing");
}

TEST_F(HandMade, DegreesAscend) {
  const auto write_p = [&](const std::vector<int>& p) { write([](auto&) {}, p); };
  write_p({2, 1});
  refused(":p: holds 2, 1, expected ascending degrees from 1 to 99");
  write_p({2, 2});
  refused(":p: holds 2, 2, expected");
  write_p({-1, 2});
  refused(":p: holds -1, expected");
  write_p({99, 100});
  refused(":p: holds 100, expected");
  write_p({});
  refused(":p: shape is (0), expected (at least 1)");
}

TEST_F(HandMade, ErrorsAreNotNegative) {
  const auto write_error = [&](double error) {
    write([&](h5::Writer& file) {
      file("S_dd_error", Eigen::Matrix2d::Constant(error).eval(), {2, 2}, "", "", h5::infinite_too);
    });
  };
  write_error(-1);
  refused(":S_dd_error: holds -1, expected numbers >= 0");
  write_error(std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isinf(read().S_dd_error(1, 0)));
}

TEST_F(HandMade, UnitsAreComparedWhereTheFileHasLabels) {
  const auto write_with = [&](const std::string& labels) {
    write([&](h5::Writer& file) { file.attribute("units", labels); }, {1}, "N/m");
  };
  write_with("metres and newtons");
  EXPECT_EQ(read().header.units, Units{});
  write_with(R"({"length": "m", "force": "N"})");
  EXPECT_EQ(read().header.units, (Units{"m", "N"}));
  write_with(R"({"length": "mm", "force": "N"})");
  refused(":S_dd: unit is 'N/m', expected 'N/mm'");
}

TEST_F(HandMade, TheSpaceIsTheTrunkSpaceUnlessTheFileSaysOtherwise) {
  const auto write_space = [&](const char* space) { write([&](h5::Writer& file) { file.attribute("space", space); }); };
  write();
  EXPECT_EQ(read().space, pfem::Space::trunk);
  write_space("trunk");
  EXPECT_EQ(read().space, pfem::Space::trunk);
  write_space("product");
  EXPECT_EQ(read().space, pfem::Space::product);
  write_space("serendipity");
  refused(": attribute 'space' is 'serendipity', expected one of trunk, product");
}

/// Before version 1.8 stresses at points stood where the waves of the rims are now.
TEST_F(HandMade, FilesWithStressesAtPointsAreRefused) {
  const auto write_as_before = [&](const char* dataset) {
    write([&](h5::Writer& file) { file(dataset, Eigen::Vector2d(1, 2), {2}, "", ""); });
  };
  for (const char* dataset : {"rim/sigma_tt", "B_d"}) {
    write_as_before(dataset);
    refused(": was written before version 1.8, with stresses at points; run stage1_plate and stage2_extract again");
  }
}

/// A disc in contact with a whole hole, and an open half hole with waves of its own.
PlateMatrices one_disc() {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  PlateMatrices a;
  a.p = a.ndof = Eigen::VectorXi::Ones(1);
  a.disc_hole = {"a"};
  a.disc_direction = {"x"};
  a.disc_modulus = Eigen::VectorXd::Constant(1, 3e7);
  a.S_dd = {one};
  a.S_dd_error = one;
  for (auto* empty : {&a.S_ee, &a.S_ed, &a.R_ef, &a.R_df, &a.T_d, &a.T_e, &a.C_t}) *empty = {Eigen::MatrixXd()};
  a.contact = {{"a", {16}, 3e7, 0.5, 0.3}};
  a.waves = {{"a", {2}, 0.5, 0.3, 3e7, Eigen::Matrix3d::Identity(), {{-3, -1}, {1, 3}}},
             {"b", {4, 0, rim::full_turn / 2}, 0.25, 0.1, 0, Eigen::Matrix3d::Constant(2)},
             {"c", {4}, 0.25, 0.1, 7, Eigen::Matrix3d::Zero(), {{0, 1}}}};
  constexpr Eigen::Index loaded = 5 + 5, others = 5 + 4 + 9 + 9;
  a.W = {StressRows::Random(loaded, 1 + loaded)};
  auto& s = a.stresses;
  s.p = a.p;
  s.rim_hole = s.section_hole = {"a"};
  s.rim_radius = s.rim_thickness = s.gross_area = s.net_area = s.stiffness_error = one;
  s.rim_center = s.bearing_area = s.rim_modulus = Eigen::MatrixXd::Constant(1, 2, 0.5);
  s.other_waves = {StressRows::Random(others, 1 + loaded)};
  s.section_force = {StressRows::Random(1, 1 + loaded)};
  s.section_shear = {StressRows::Random(1, 1 + loaded)};
  s.section_side = {"+x"};
  return a;
}

TEST(PlateMatrices, WavesReadBack) {
  const test::TemporaryFolder folder;
  const PlateMatrices a = one_disc();
  EXPECT_EQ(a.n_loaded_waves(), 10);
  EXPECT_EQ(a.n_waves(), 10 + 9 + 18);
  EXPECT_EQ(a.n_waves_before(1), 10);
  EXPECT_EQ(a.n_cases(), 11);
  write(folder.path("m.h5"), a);
  const PlateMatrices b = read_plate_matrices(folder.path("m.h5"));
  ASSERT_EQ(b.waves.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(b.waves[i].hole, a.waves[i].hole);
    EXPECT_EQ(b.waves[i].waves, a.waves[i].waves);
    EXPECT_EQ(b.waves[i].radius, a.waves[i].radius);
    EXPECT_EQ(b.waves[i].area, a.waves[i].area);
    EXPECT_EQ(b.waves[i].modulus, a.waves[i].modulus);
    EXPECT_EQ(b.waves[i].compliance, a.waves[i].compliance);
    EXPECT_EQ(b.waves[i].acts, a.waves[i].acts) << "two arcs, none, one";
  }
  EXPECT_TRUE(b.waves[0].has_closed_form());
  EXPECT_FALSE(b.waves[2].has_closed_form());
  EXPECT_EQ(b.contact[0].pressures, rim::Harmonics{16}) << "of stage 3, which are not the elements'";
  EXPECT_EQ(b.W, a.W);
  EXPECT_EQ(b.stresses.other_waves, a.stresses.other_waves);
  EXPECT_EQ(b.stresses.section_force, a.stresses.section_force);
  EXPECT_EQ(b.stresses.section_shear, a.stresses.section_shear);
}

TEST(PlateMatrices, StressesThatNoPlateHasAreRefused) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("m.h5");
  const auto refused = [&](const std::function<void(PlateStresses&, PlateMatrices&)>& edit,
                           const std::string& message) {
    PlateMatrices a = one_disc();
    edit(a.stresses, a);
    write(path, a);
    EXPECT_THAT([&] { (void)read_plate_matrices(path); }, ThrowsMessage<FileError>(HasSubstr("m.h5:" + message)));
  };
  write(path, one_disc());
  EXPECT_EQ(read_plate_matrices(path).stresses.section_side.at(0), "+x");
  refused([](auto& s, auto&) { s.bearing_area(0, 1) = 0; }, "rim/bearing_area: holds 0, expected numbers > 0");
  refused([](auto& s, auto&) { s.section_side = {""}; }, "section/side: holds \"\", expected one of +x, -x, +y, -y");
  refused([](auto& s, auto&) { s.p[0] = 100; }, "stress/p: holds 100, expected ascending degrees from 1 to 99");
  refused([](auto&, auto& a) { a.waves[2].radius = 0; }, "wave/radius: holds 0, expected numbers > 0");
  refused([](auto&, auto& a) { a.waves[0].compliance *= -1; },
          "wave/compliance: that of hole \"a\" is not positive definite, expected a positive definite matrix, or 0");
  refused([](auto&, auto& a) { a.waves[1].modulus = -1; }, "wave/modulus: holds -1, expected numbers >= 0");
}

/// What a field is made of; the rest is written alone.
TEST(JointResult, ReadsBackAlsoWithoutAnyIncrement) {
  for (const Eigen::Index steps : {0, 2}) {
    const test::TemporaryFolder folder;
    JointResult a;
    a.header = {"test 1", "joint", {"mm", "N"}, "{}"};
    a.complete = steps > 0;
    a.load_factor = Eigen::VectorXd::LinSpaced(steps, 0.5, 1);
    a.case_name = {""};
    a.case_of = Eigen::VectorXi::Zero(steps);
    a.converged = a.iterations = Eigen::VectorXi::Ones(steps);
    a.residual = Eigen::VectorXd::Zero(steps);
    a.event.assign(steps, "1 closes");
    for (const char* path : {"F", "delta", "F_vector", "delta_vector", "transferred"})
      a.columns.put(
          {{path, columns::force, "of planes"}, columns::Of::plane, 3, {}, Eigen::MatrixXd::Random(steps, 3)});
    PlateHistory& plate = a.plates.emplace_back();
    plate.name = "top";
    plate.plate_digest = "0123456789abcdef";
    plate.disc_hole = {"1"};
    plate.disc_direction = {"x"};
    plate.friction_hole = {"2", "2"};
    plate.friction_bearing = {"+x", "-x"};
    plate.contact = {{"1", {6}, 3e4, 5, 20}};
    plate.waves = {{"1", {4}, 5, 20, 3e4}};
    plate.at_no_load.gap = plate.at_no_load.peak = plate.at_no_load.least = plate.at_no_load.full_until =
        Eigen::VectorXd::Constant(1, 0.01);
    const columns::Quantity angle{"rim/peak_angle", columns::angle, "place", "", h5::nan_too};
    for (const auto& [quantity, n] :
         {std::pair(&De, 0), std::pair(&free_De, 0), std::pair(&D, 1), std::pair(&free_D, 1),
          std::pair(&wave_amount, 18), std::pair(&Lambda, 2), std::pair(&traction_force, 0)})
      plate.columns.put({*quantity, {}, n, {}, Eigen::MatrixXd::Random(steps, n)});
    plate.columns.put({angle, {}, 1, {{"x", "y"}}, Eigen::MatrixXd::Constant(steps, 2, std::nan(""))});
    write(folder.path("r.h5"), a);
    const JointResult b = read_joint_result(folder.path("r.h5"));
    EXPECT_EQ(b.header.units, a.header.units);
    EXPECT_EQ(b.complete, a.complete);
    EXPECT_EQ(b.load_factor, a.load_factor);
    const PlateHistory& its = b.plates.at(0);
    EXPECT_EQ(its.plate_digest, plate.plate_digest);
    for (const auto* quantity : {&De, &free_De, &D, &free_D, &wave_amount, &Lambda, &traction_force})
      EXPECT_EQ(its.columns[quantity->path], plate.columns[quantity->path]) << quantity->path;
    ASSERT_EQ(its.waves.size(), 1U);
    EXPECT_EQ(its.waves[0].hole, "1");
    EXPECT_EQ(its.waves[0].waves, rim::Harmonics{4});
    EXPECT_EQ(its.friction_bearing, plate.friction_bearing);
    const test::Result all(folder.path("r.h5"));
    EXPECT_EQ(all.F, a.columns["F"]);
    EXPECT_EQ(all["plates/top/rim/peak_angle"].rows(), steps);
    EXPECT_TRUE(all["plates/top/rim/peak_angle"].array().isNaN().all());
  }
}

}  // namespace
}  // namespace fastjoint::formats
