// SPDX-License-Identifier: Apache-2.0
// Result<T>: a value, or one clear sentence about what was wrong with the input.
//
// For what a user can get wrong: files, options, prescriptions. A programmer's error is a failed
// check (base/check.h); a ray that misses is a value (optics/ray.h), never an error.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace lorgnette {

// kUsage: the request cannot be meant (exit code 2). kFailure: it could not be done (exit code 1).
enum class ErrorKind { kUsage, kFailure };

struct Error {
  std::string message;  // `file:key: got -4.2, want 0..180`; no full stop, no newline
  ErrorKind kind = ErrorKind::kFailure;
};

template <typename T>
using Result = tl::expected<T, Error>;
using Status = Result<void>;

inline tl::unexpected<Error> UsageError(std::string message) {
  return tl::unexpected<Error>(Error{std::move(message), ErrorKind::kUsage});
}
inline tl::unexpected<Error> Failure(std::string message) {
  return tl::unexpected<Error>(Error{std::move(message), ErrorKind::kFailure});
}

}  // namespace lorgnette

// Evaluates `expr` (a Result<T>) once; on error returns that error from the enclosing function,
// otherwise binds the value to the declaration `decl`:  LG_ASSIGN(const Lens lens, Design(order));
#define LG_CONCAT_INNER(a, b) a##b
#define LG_CONCAT(a, b) LG_CONCAT_INNER(a, b)
#define LG_ASSIGN(decl, expr) LG_ASSIGN_IMPL(LG_CONCAT(lg_result_, __LINE__), decl, expr)
#define LG_ASSIGN_IMPL(tmp, decl, expr)                    \
  auto tmp = (expr);                                       \
  if (!tmp) return tl::unexpected(std::move(tmp).error()); \
  decl = *std::move(tmp)
// The same for a Status, with nothing to bind.
#define LG_RETURN_IF_ERROR(expr)                                                                  \
  do {                                                                                            \
    if (auto lg_status = (expr); !lg_status) return tl::unexpected(std::move(lg_status).error()); \
  } while (false)
