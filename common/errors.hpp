// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>

namespace fastjoint {

/// The user's option, JSON, mesh or joint is wrong: exit status 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file cannot be read or written, is damaged, or is of the wrong kind or version: exit status 3.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Singular, indefinite or not converged: exit status 4.
struct NumericalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The same after what converged has been written and summarised.
struct IncompleteResult : NumericalError {
  using NumericalError::NumericalError;
};

}  // namespace fastjoint
