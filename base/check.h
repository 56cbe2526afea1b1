// SPDX-License-Identifier: Apache-2.0
// Checks for programmer errors: they print both operands and abort, in every build type.
#pragma once

#include <cstdlib>
#include <iostream>

#define LG_CHECK(condition)                                                              \
  do {                                                                                   \
    if (!(condition)) {                                                                  \
      std::cerr << __FILE__ << ':' << __LINE__ << ": check failed: " #condition << '\n'; \
      std::abort();                                                                      \
    }                                                                                    \
  } while (false)

#define LG_CHECK_OP(a, op, b)                                                               \
  do {                                                                                      \
    const auto& lg_lhs = (a);                                                               \
    const auto& lg_rhs = (b);                                                               \
    if (!(lg_lhs op lg_rhs)) {                                                              \
      std::cerr << __FILE__ << ':' << __LINE__ << ": check failed: " #a " " #op " " #b " (" \
                << lg_lhs << " against " << lg_rhs << ")\n";                                \
      std::abort();                                                                         \
    }                                                                                       \
  } while (false)

#define LG_CHECK_EQ(a, b) LG_CHECK_OP(a, ==, b)
#define LG_CHECK_NE(a, b) LG_CHECK_OP(a, !=, b)
#define LG_CHECK_LT(a, b) LG_CHECK_OP(a, <, b)
#define LG_CHECK_LE(a, b) LG_CHECK_OP(a, <=, b)
#define LG_CHECK_GT(a, b) LG_CHECK_OP(a, >, b)
#define LG_CHECK_GE(a, b) LG_CHECK_OP(a, >=, b)
