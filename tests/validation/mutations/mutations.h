// SPDX-License-Identifier: Apache-2.0
// Formulas broken on purpose, to see the validation cases that guard them turn red.
//
// The linker puts a wrapper before each function named in CMakeLists.txt (--wrap); a wrapper calls
// the real one unless its own mutation is the active one. No source of the program knows of it.
#pragma once

#include <string>
#include <vector>

namespace lorgnette::mutations {

struct Mutation {
  const char* name;
  const char* what;                // what is wrong in the formula
  std::vector<const char*> cases;  // that have to turn red
};

const std::vector<Mutation>& All();

// Makes one mutation active for the life of the object; none is without.
class Active {
 public:
  explicit Active(const std::string& name);
  ~Active();
  Active(const Active&) = delete;
  Active& operator=(const Active&) = delete;
};

}  // namespace lorgnette::mutations
