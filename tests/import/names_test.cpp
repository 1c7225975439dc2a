// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The tables of names against the documentation and against what the importer does with each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "base/spelling.h"
#include "import/detail/pbrt/names.h"
#include "import_text.h"

namespace caplet::test {
namespace {

/// The names in backticks of a table cell.
std::vector<std::string> names_in(const std::string& cell) {
  std::vector<std::string> names;
  for (std::size_t at = cell.find('`'); at != std::string::npos;) {
    const std::size_t end = cell.find('`', at + 1);
    names.push_back(cell.substr(at + 1, end - at - 1));
    at = cell.find('`', end + 1);
  }
  return names;
}

TEST(Names, DocumentationListsThem) {
  std::ifstream page(source_folder() / "docs" / "formats" / "pbrt.md");
  std::map<std::string, std::vector<std::string>> rows;
  for (std::string line; std::getline(page, line) && line != "## Directives";) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, '|');) cells.push_back(cell);
    if (cells.size() == 4 && names_in(cells[1]).size() == 1)
      rows[names_in(cells[1])[0]] = {cells[2], cells[3]};
  }
  EXPECT_EQ(rows.size(), pbrt::name_tables().size());
  for (const pbrt::NameTable& table : pbrt::name_tables()) {
    ASSERT_TRUE(rows.contains(table.directive)) << table.directive;
    EXPECT_EQ(names_in(rows[table.directive][0]), table.accepted) << table.directive;
    EXPECT_EQ(names_in(rows[table.directive][1]), table.refused) << table.directive;
  }
}

TEST(Names, RefusedOnesAreRefusedByName) {
  for (const pbrt::NameTable& table : pbrt::name_tables())
    for (const std::string& name : table.refused) {
      if (table.directive == "Texture" || table.directive == "Option" ||
          table.directive == "ActiveTransform")
        continue;
      const std::string before =
          table.directive == "MakeNamedMedium" ? "MakeNamedMedium \"m\" \"string type\" \"" + name +
                                                     "\"\nMediumInterface \"m\"\nWorldBegin\n"
          : table.directive == "Material" || table.directive == "LightSource" ||
                  table.directive == "Shape"
              ? "WorldBegin\n" + table.directive + " \"" + name + "\"\n"
              : table.directive + " \"" + name + "\"\nWorldBegin\n";
      EXPECT_THAT(complaints(before + "Shape \"sphere\""),
                  testing::ElementsAre(
                      testing::AllOf(testing::HasSubstr(table.directive + " \"" + name + "\""),
                                     testing::HasSubstr("is not rendered yet"))));
    }
}

TEST(Names, EveryDirectiveHasAHandler) {
  for (const std::string& name : pbrt::directive_names())
    for (const std::string& message : complaints(name + "\n"))
      EXPECT_THAT(message, testing::Not(testing::HasSubstr("unknown directive"))) << name;
}

TEST(Names, OfNoDirectiveAreUnknown) {
  const pbrt::Refusal refusal = pbrt::refusal_of("Shap", "sphere");
  EXPECT_FALSE(refusal.is_known);
  EXPECT_EQ(refusal.text, "unknown directive \"Shap\"");
}

TEST(Names, NearestIsByEditDistance) {
  EXPECT_EQ(nearest_name("spehre", {"disk", "sphere", "cone"}), "sphere");
  EXPECT_EQ(nearest_name("x", {}), "");
}

}  // namespace
}  // namespace caplet::test
