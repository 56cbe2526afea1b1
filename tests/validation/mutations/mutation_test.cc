// SPDX-License-Identifier: Apache-2.0
// Each deliberate mistake turns the cases red that are said to guard against it, and none is red
// without one.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/validation/mutations/mutations.h"
#include "validation/suite.h"

namespace lorgnette::validation {
namespace {

bool Passes(const std::string& id) {
  const auto result = RunSuite(id, "");
  return result && result->passed == 1;
}

TEST(Mutations, AreManyAndEachIsGuarded) {
  std::set<std::string> names;
  for (const auto& one : mutations::All()) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_FALSE(one.cases.empty()) << one.name;
  }
  EXPECT_GE(names.size(), 10u);
}

TEST(Mutations, WithoutOneTheirCasesPass) {
  std::set<std::string> cases;
  for (const auto& one : mutations::All()) cases.insert(one.cases.begin(), one.cases.end());
  for (const std::string& id : cases) EXPECT_TRUE(Passes(id)) << id;
}

class Broken : public testing::TestWithParam<mutations::Mutation> {};

TEST_P(Broken, TurnsItsCasesRed) {
  const mutations::Active active(GetParam().name);
  for (const char* id : GetParam().cases) {
    EXPECT_FALSE(Passes(id)) << id << " does not see: " << GetParam().what;
  }
}

INSTANTIATE_TEST_SUITE_P(Formulas, Broken, testing::ValuesIn(mutations::All()),
                         [](const auto& parameter) {
                           std::string name = parameter.param.name;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace lorgnette::validation
