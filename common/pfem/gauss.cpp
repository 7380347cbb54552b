// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/gauss.hpp"

#include <gsl/gsl_integration.h>

#include <cassert>
#include <memory>
#include <new>

namespace fastjoint::pfem {

Rule gauss(int n) {
  assert(n >= 1);
  const std::unique_ptr<gsl_integration_glfixed_table, decltype(&gsl_integration_glfixed_table_free)> table(
      gsl_integration_glfixed_table_alloc(n), &gsl_integration_glfixed_table_free);
  if (!table) throw std::bad_alloc();
  Rule rule{Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (int i = 0; i < n; ++i) gsl_integration_glfixed_point(-1, 1, i, &rule.x[i], &rule.w[i], table.get());
  return rule;
}

}  // namespace fastjoint::pfem
