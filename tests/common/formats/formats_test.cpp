// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "common/errors.hpp"
#include "common/formats/joint_result.hpp"
#include "common/formats/plate_matrices.hpp"
#include "common/h5/writer.hpp"
#include "tests/support/files.hpp"

namespace fastjoint::formats {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

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

TEST(Space, IsTheTrunkSpaceInAFileWithoutIt) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("plate.h5");
  const auto read = [&](const char* space) {
    h5::Writer file(path, "plate-solution", 2, 0);
    if (space != nullptr) file.attribute("space", space);
    file.commit();
    return read_space(h5::Reader(path, "plate-solution", 2));
  };
  EXPECT_EQ(read(nullptr), pfem::Space::trunk);
  EXPECT_EQ(read("trunk"), pfem::Space::trunk);
  EXPECT_EQ(read("product"), pfem::Space::product);
  EXPECT_THAT([&] { (void)read("serendipity"); },
              ThrowsMessage<FileError>(
                  HasSubstr("plate.h5: attribute 'space' is 'serendipity', expected one of trunk, product")));
}

/// Matrices as a laboratory would write them: only what must be there.
TEST(PlateMatrices, HandMadeFilesMayLeaveOutWhatTheyDoNotHave) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("lab.h5");
  h5::Writer file(path, "plate-matrices", 1, 0);
  file.write("p", Eigen::VectorXi(Eigen::VectorXi::Constant(1, 1)), {"1", ""});
  file.write("disc/hole", std::vector<std::string>{"a", "b"}, {"1", ""});
  file.write("disc/direction", std::vector<std::string>{"x", "x"}, {"1", ""});
  file.write("S_dd", {Eigen::MatrixXd::Identity(2, 2)}, 2, 2, {"force/length", ""});
  file.commit();
  const PlateMatrices a = read_plate_matrices(path);
  EXPECT_EQ(a.n_discs(), 2);
  EXPECT_EQ(a.n_externals() + a.n_friction_cases() + a.n_tractions(), 0);
  EXPECT_EQ(a.S_dd.at(0), Eigen::MatrixXd::Identity(2, 2));
  EXPECT_EQ(a.R_df.at(0).rows(), 2);
  EXPECT_TRUE(std::isinf(a.S_dd_error(0, 0)));
}

/// What the length of one dataset says of another, and what degrees there are, hold in a hand-made file too.
class HandMade : public testing::Test {
 protected:
  void write(const std::vector<int>& p, bool with_bearing = true, const std::string& side = "-x") const {
    const Eigen::Index n = p.size();
    h5::Writer file(path_, "plate-matrices", 1, 0);
    file.write("p", Eigen::VectorXi(Eigen::Map<const Eigen::VectorXi>(p.data(), n)), {"1", ""});
    file.write("disc/hole", std::vector<std::string>{"a"}, {"1", ""});
    file.write("S_dd", std::vector<Eigen::MatrixXd>(p.size(), Eigen::MatrixXd::Identity(1, 1)), 1, 1, {"1", ""});
    file.write("disc/direction", std::vector<std::string>{"x"}, {"1", ""});
    file.write("friction/hole", std::vector<std::string>{"a", "a"}, {"1", ""});
    if (with_bearing) file.write("friction/bearing", std::vector<std::string>{"+x", side}, {"1", ""});
    for (const char* each : {"friction/unit_force", "friction/resultant"})
      file.write(each, Eigen::VectorXd(Eigen::VectorXd::Ones(2)), {"1", ""});
    file.write("R_df", std::vector<Eigen::MatrixXd>(p.size(), Eigen::MatrixXd::Zero(1, 2)), 1, 2, {"1", ""});
    file.commit();
  }
  void refused(const std::string& message) const {
    EXPECT_THAT([&] { (void)read_plate_matrices(path_); }, ThrowsMessage<FileError>(HasSubstr(message)));
  }

 private:
  test::TemporaryFolder folder_;
  std::string path_ = folder_.path("lab.h5");
};

TEST_F(HandMade, EveryFrictionCaseHasASide) {
  write({1}, false);
  refused("lab.h5:friction/bearing: dataset is missing");
  write({1}, true, "x");
  refused("lab.h5:friction/bearing: holds \"x\", expected one of +x, -x, +y, -y");
}

TEST_F(HandMade, DegreesAscend) {
  write({2, 1});
  refused("lab.h5:p: is 2, 1, expected ascending degrees from 1 to 99");
  write({2, 2});
  refused("lab.h5:p: is 2, 2, expected");
  write({-1, 2});
  refused("lab.h5:p: is -1, 2, expected");
  write({});
  refused("lab.h5:p: holds no degree");
}

TEST(PlateMatrices, UnitsAreComparedWhereTheFileHasLabels) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("lab.h5");
  const auto write_with = [&](const std::string& labels) {
    h5::Writer file(path, "plate-matrices", 1, 0);
    file.attribute("units", labels);
    file.write("p", Eigen::VectorXi(Eigen::VectorXi::Constant(1, 1)), {"1", ""});
    file.write("disc/hole", std::vector<std::string>{"a"}, {"1", ""});
    file.write("disc/direction", std::vector<std::string>{"x"}, {"1", ""});
    file.write("S_dd", {Eigen::MatrixXd::Identity(1, 1)}, 1, 1, {"N/m", ""});
    file.commit();
  };
  write_with("metres and newtons");
  EXPECT_EQ(read_plate_matrices(path).header.units, Units{});
  write_with(R"({"length": "m", "force": "N"})");
  EXPECT_EQ(read_plate_matrices(path).header.units, (Units{"m", "N"}));
  write_with(R"({"length": "mm", "force": "N"})");
  EXPECT_THAT([&] { (void)read_plate_matrices(path); },
              ThrowsMessage<FileError>(HasSubstr("lab.h5:S_dd: unit is 'N/m', expected 'N/mm'")));
}

TEST(PlateMatrices, AnExternalNeedsItsStiffness) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("lab.h5");
  h5::Writer file(path, "plate-matrices", 1, 0);
  file.write("p", Eigen::VectorXi(Eigen::VectorXi::Constant(1, 1)), {"1", ""});
  file.write("disc/hole", std::vector<std::string>{"a"}, {"1", ""});
  file.write("disc/direction", std::vector<std::string>{"x"}, {"1", ""});
  file.write("external/id", std::vector<std::string>{"P"}, {"1", ""});
  file.write("S_dd", {Eigen::MatrixXd::Identity(1, 1)}, 1, 1, {"force/length", ""});
  file.commit();
  EXPECT_THAT([&] { (void)read_plate_matrices(path); },
              ThrowsMessage<FileError>(HasSubstr("lab.h5:S_ee: dataset is missing")));
}

TEST(PlateMatrices, StressesThatNoPlateHasAreRefused) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("m.h5");
  const auto write_with = [&](double area, const std::string& side) {
    PlateMatrices a;
    a.p = Eigen::VectorXi::Constant(1, 1);
    a.ndof = a.p;
    a.disc_hole = {"a"};
    a.disc_direction = {"x"};
    a.disc_modulus = Eigen::VectorXd::Constant(1, 3e7);
    a.S_dd = {Eigen::MatrixXd::Identity(1, 1)};
    a.S_dd_error = Eigen::MatrixXd::Zero(1, 1);
    a.S_ed_error = Eigen::MatrixXd::Zero(0, 1);
    const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
    auto& s = a.stresses;
    s.p = a.p;
    s.rim_hole = s.section_hole = {"a"};
    s.rim_center = Eigen::MatrixXd::Zero(1, 2);
    s.rim_radius = s.rim_thickness = s.gross_area = s.net_area = s.angle = Eigen::VectorXd::Ones(1);
    s.bearing_area = s.rim_modulus = Eigen::MatrixXd::Constant(1, 2, area);
    s.rim_start = Eigen::VectorXi::LinSpaced(2, 0, 1);
    s.sigma_rr = s.sigma_tt = s.sigma_rt = s.section_force = {one};
    s.section_side = {side};
    a.R_df = a.T_d = {Eigen::MatrixXd(1, 0)};
    a.S_ed = {Eigen::MatrixXd(0, 1)};
    a.S_ee = a.R_ef = a.T_e = a.C_t = {Eigen::MatrixXd(0, 0)};
    a.load_displacement.resize(0, 1);
    write(path, a);
  };
  write_with(0.5, "+x");
  EXPECT_EQ(read_plate_matrices(path).stresses.section_side.at(0), "+x");
  write_with(0, "+x");
  EXPECT_THAT([&] { (void)read_plate_matrices(path); },
              ThrowsMessage<FileError>(HasSubstr("m.h5:rim/bearing_area: holds 0, expected numbers > 0")));
  write_with(0.5, "");
  EXPECT_THAT([&] { (void)read_plate_matrices(path); },
              ThrowsMessage<FileError>(HasSubstr("m.h5:section/side: holds \"\", expected one of +x, -x, +y, -y")));
}

TEST(JointResult, ReadsBackAlsoWithoutAnyIncrement) {
  for (const Eigen::Index steps : {0, 2}) {
    const test::TemporaryFolder folder;
    JointResult a;
    a.header = {"test 1", "joint", {"mm", "N"}, "{}"};
    a.complete = steps > 0;
    a.load_factor = Eigen::VectorXd::LinSpaced(steps, 0.5, 1);
    a.converged = a.iterations = Eigen::VectorXi::Ones(steps);
    a.residual = Eigen::VectorXd::Zero(steps);
    a.event.assign(steps, "1 closes");
    a.fastener_id = {"1", "2", "3"};
    a.delta = a.F = a.transferred_first = Eigen::MatrixXd::Random(steps, 3);
    a.transferred_second = 2 * a.F;
    a.first_hole = {"top:1", "top:2", "top:3"};
    a.second_hole = {"low:1", "low:2", "low:3"};
    a.direction = {"x", "y"};
    a.delta_vector = a.F_vector = Eigen::MatrixXd::Random(steps, 6);
    PlateHistory& plate = a.plates.emplace_back();
    plate.name = "top";
    plate.plate_digest = "0123456789abcdef";
    plate.disc_hole = {"1"};
    plate.disc_direction = {"x"};
    plate.friction_hole = {"1", "1"};
    plate.friction_bearing = {"+x", "-x"};
    plate.D = Eigen::MatrixXd::Random(steps, 1);
    plate.De = plate.Pe = plate.traction = Eigen::MatrixXd(steps, 0);
    plate.Lambda = Eigen::MatrixXd::Random(steps, 2);
    RimHistory& rims = plate.rims;
    rims.hole = {"1"};
    rims.sections = Eigen::VectorXi::Constant(1, 2);
    for (auto* table :
         {&rims.bearing_load, &rims.bearing_load_y, &rims.bearing_stress, &rims.bypass_load, &rims.bypass_error,
          &rims.peak_hoop, &rims.peak_angle, &rims.peak_error, &rims.gross_concentration, &rims.net_concentration})
      *table = Eigen::MatrixXd::Random(steps, 1);
    // As of one degree alone.
    for (auto* error : {&rims.bypass_error, &rims.peak_error})
      error->setConstant(std::numeric_limits<double>::infinity());
    write(folder.path("r.h5"), a);
    EXPECT_FALSE(read_joint_result(folder.path("r.h5")).sensitivity);
    SensitivityHistory& by = a.sensitivity.emplace();
    const auto tables = [&](Eigen::Index columns) {
      return std::vector<Eigen::MatrixXd>(steps, Eigen::MatrixXd::Random(3, columns));
    };
    by.load_factor = Eigen::MatrixXd::Constant(steps, 3, std::numeric_limits<double>::infinity());
    by.clearance = tables(3);
    by.mu = tables(0);
    by.law_name = by.law_number = by.law_unit = {"k"};
    by.law = tables(1);
    by.force_external = {"top:P", "low:Q"};
    by.force = tables(2);
    by.displacement_external = {"top:D"};
    by.displacement = tables(1);
    write(folder.path("r.h5"), a);
    const JointResult b = read_joint_result(folder.path("r.h5"));
    EXPECT_EQ(b.header.units, a.header.units);
    EXPECT_EQ(b.complete, a.complete);
    EXPECT_EQ(b.load_factor, a.load_factor);
    EXPECT_EQ(b.event, a.event);
    EXPECT_EQ(b.fastener_id, a.fastener_id);
    EXPECT_EQ(b.F, a.F);
    EXPECT_EQ(b.F_vector, a.F_vector);
    EXPECT_EQ(b.second_hole, a.second_hole);
    EXPECT_EQ(b.transferred_second, a.transferred_second);
    EXPECT_EQ(b.plates.at(0).D, plate.D);
    EXPECT_EQ(b.plates[0].plate_digest, plate.plate_digest);
    EXPECT_EQ(b.plates[0].Lambda, plate.Lambda);
    EXPECT_EQ(b.plates[0].friction_bearing, plate.friction_bearing);
    EXPECT_EQ(b.plates[0].rims.sections, rims.sections);
    EXPECT_EQ(b.plates[0].rims.bypass_error, rims.bypass_error);
    EXPECT_EQ(b.plates[0].rims.peak_error, rims.peak_error);
    EXPECT_EQ(b.plates[0].rims.peak_hoop, rims.peak_hoop);
    EXPECT_EQ(b.plates[0].rims.net_concentration, rims.net_concentration);
    const SensitivityHistory by_file = b.sensitivity.value();
    EXPECT_EQ(by_file.load_factor, by.load_factor) << "infinite where there is none";
    EXPECT_EQ(by_file.clearance, by.clearance);
    EXPECT_EQ(by_file.mu, by.mu);
    EXPECT_EQ(by_file.law_unit, by.law_unit);
    EXPECT_EQ(by_file.law, by.law);
    EXPECT_EQ(by_file.force_external, by.force_external);
    EXPECT_EQ(by_file.force, by.force);
    EXPECT_EQ(by_file.displacement, by.displacement);
  }
}

}  // namespace
}  // namespace fastjoint::formats
