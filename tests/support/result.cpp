// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/result.hpp"

#include "common/errors.hpp"
#include "common/h5/reader.hpp"

namespace fastjoint::test {
namespace {

h5::Reader open(const std::string& result) { return {result, {"joint-result", 1, 0}}; }

}  // namespace

Result::Result(const std::string& path) : JointResult(formats::read_joint_result(path)), path_(path) {
  for (const auto& [name, numbers] : {std::pair("F", &F), std::pair("delta", &delta), std::pair("F_vector", &F_vector),
                                      std::pair("delta_vector", &delta_vector), std::pair("transferred", &transferred)})
    *numbers = (*this)[name];
  h5::Reader file = open(path_);
  file("converged", converged, {h5::any}, "1", "");
  file("iterations", iterations, {h5::any}, "1", "");
  file("residual", residual, {h5::any}, "1", "");
  event = texts("event");
  first_hole = texts("fastener/first");
  second_hole = texts("fastener/second");
  fastener_id = texts("fastener/id");
  direction = texts("direction");
}

Eigen::MatrixXd Result::operator[](const std::string& dataset) const {
  h5::Reader file = open(path_);
  file.compare_units(false);
  h5::Allowed all = h5::infinite_too;
  all.may_be_nan = true;
  Eigen::MatrixXd numbers;
  for (h5::Shape shape{h5::any};; shape.push_back(h5::any)) try {
      file(dataset, numbers, shape, "", "", all);
      return numbers;
    } catch (const FileError&) {
      if (shape.size() == 3) throw;
    }
}

std::vector<std::string> Result::texts(const std::string& dataset) const {
  std::vector<std::string> all;
  open(path_)(dataset, all, {h5::any}, "1", "");
  return all;
}

bool Result::has(const std::string& dataset) const { return open(path_).has(dataset); }

}  // namespace fastjoint::test
