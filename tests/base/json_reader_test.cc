// SPDX-License-Identifier: Apache-2.0
#include "base/json_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace lorgnette {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

JsonReader Read(const std::string& text) { return JsonReader::Parse(text, "rx.json").value(); }

std::string ParseMessage(const std::string& text) {
  const Result<JsonReader> reader = JsonReader::Parse(text, "rx.json");
  return reader ? "" : reader.error().message;
}

std::string FinishMessage(const JsonReader& reader) {
  const Status status = reader.Finish();
  return status ? "" : status.error().message;
}

TEST(JsonReader, ReadsEveryKindOfValue) {
  JsonReader json = Read(R"({"sphere": -4.25, "count": 3, "on": true, "name": "OD",
                             "grid": [[1, 2], [3, 4.5]], "none": null,
                             "inner": {"pd": 64}, "list": [{"k": 1}, {"k": 2}], "note": "x"})");
  EXPECT_EQ(json.Number("sphere", -30, 30), -4.25);
  EXPECT_EQ(json.IntegerOr("count", 0, 0, 10), 3);
  EXPECT_TRUE(json.BoolOr("on", false));
  EXPECT_EQ(json.String("name"), "OD");
  EXPECT_THAT(json.Numbers("grid"), ElementsAre(1, 2, 3, 4.5));
  EXPECT_EQ(json.NumberOr("none", 7, 0, 1), 7);
  EXPECT_EQ(json.Object("inner").Number("pd", 40, 80), 64);
  auto list = json.Objects("list");
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].Number("k", 0, 9), 1);
  EXPECT_EQ(list[1].Number("k", 0, 9), 2);
  json.Ignore("note");
  EXPECT_EQ(FinishMessage(json), "");
}

TEST(JsonReader, FallsBackOnlyWhenTheKeyIsAbsent) {
  JsonReader json = Read("{}");
  EXPECT_EQ(json.NumberOr("pd", 64, 40, 80), 64);
  EXPECT_EQ(json.IntegerOr("n", 5, 0, 10), 5);
  EXPECT_TRUE(json.BoolOr("on", true));
  EXPECT_EQ(json.StringOr("name", "plain"), "plain");
  EXPECT_FALSE(json.Has("pd"));
  EXPECT_EQ(FinishMessage(json), "");
}

TEST(JsonReader, NamesFileKeyValueAndRange) {
  JsonReader json = Read(R"({"OD": {"axis": -4.2}})");
  JsonReader od = json.Object("OD");
  od.Number("axis", 0, 180);
  EXPECT_EQ(FinishMessage(json), "rx.json:OD.axis: got -4.2, want 0..180");
  EXPECT_EQ(json.Finish().error().kind, ErrorKind::kUsage);
}

TEST(JsonReader, TakesBothEndsOfARangeAndNothingOutside) {
  const std::string text = R"({"low": 0, "high": 180, "over": 180.00001})";
  JsonReader json = Read(text);
  EXPECT_EQ(json.Number("low", 0, 180), 0);
  EXPECT_EQ(json.Number("high", 0, 180), 180);
  json.Number("over", 0, 180);
  EXPECT_EQ(FinishMessage(json), "rx.json:over: got 180.00001, want 0..180");
}

TEST(JsonReader, SaysOpenRangesInWords) {
  JsonReader low = Read(R"({"t": -1})");
  low.Number("t", 0, kInfinity);
  EXPECT_EQ(FinishMessage(low), "rx.json:t: got -1, want a number of at least 0");
  JsonReader high = Read(R"({"t": 2})");
  high.Number("t", -kInfinity, 1);
  EXPECT_EQ(FinishMessage(high), "rx.json:t: got 2, want a number of at most 1");
  JsonReader any = Read(R"({"t": "2"})");
  any.Number("t", -kInfinity, kInfinity);
  EXPECT_EQ(FinishMessage(any), "rx.json:t: got \"2\", want a number");
}

TEST(JsonReader, RefusesTheWrongType) {
  const std::string text = R"({"s": "text", "n": 1, "o": {}, "a": [1, "x"], "h": 2.5})";
  const auto message = [&](auto use) {
    JsonReader json = Read(text);
    use(json);
    return FinishMessage(json);
  };
  EXPECT_EQ(message([](JsonReader& j) { j.Number("s", 0, 1); }),
            "rx.json:s: got \"text\", want 0..1");
  EXPECT_EQ(message([](JsonReader& j) { j.String("n"); }), "rx.json:n: got 1, want a string");
  EXPECT_EQ(message([](JsonReader& j) { j.BoolOr("n", true); }),
            "rx.json:n: got 1, want true or false");
  EXPECT_EQ(message([](JsonReader& j) { j.IntegerOr("h", 1, 0, 9); }),
            "rx.json:h: got 2.5, want a whole number 0..9");
  EXPECT_EQ(message([](JsonReader& j) { j.Number("o", 0, 1); }),
            "rx.json:o: got an object, want 0..1");
  EXPECT_EQ(message([](JsonReader& j) { j.Object("a"); }),
            "rx.json:a: got an array of 2, want an object");
  EXPECT_EQ(message([](JsonReader& j) { j.Objects("a"); }), "rx.json:a[0]: got 1, want an object");
  EXPECT_EQ(message([](JsonReader& j) { j.Objects("o"); }),
            "rx.json:o: got an object, want an array of objects");
  EXPECT_EQ(message([](JsonReader& j) { j.Numbers("a"); }),
            "rx.json:a: got an array with something else in it, want numbers only");
  EXPECT_EQ(message([](JsonReader& j) { j.Numbers("n"); }),
            "rx.json:n: got 1, want an array of numbers");
}

TEST(JsonReader, NamesAMissingKey) {
  JsonReader json = Read("{}");
  json.Object("OD").Number("sphere", -30, 30);
  EXPECT_EQ(FinishMessage(json), "rx.json:OD: missing, want an object");
  JsonReader null = Read(R"({"PD": null})");
  null.Number("PD", 40, 80);
  EXPECT_EQ(FinishMessage(null), "rx.json:PD: missing, want 40..80");
}

TEST(JsonReader, NamesAnUnknownKeyAndTheKnownOnes) {
  JsonReader json = Read(R"({"OD": {"sphere": -1, "cyl": 2}})");
  JsonReader od = json.Object("OD");
  od.Number("sphere", -30, 30);
  od.NumberOr("cylinder", 0, -10, 10);
  EXPECT_EQ(FinishMessage(json), "rx.json:OD.cyl: unknown key, want sphere, cylinder");
}

TEST(JsonReader, ShowsAnyKeyOnOneLine) {
  JsonReader json = Read(R"({"a\nb": 1})");
  EXPECT_EQ(FinishMessage(json), R"(rx.json:a\nb: unknown key, want none here)");
  const auto twice = JsonReader::Parse(R"({"a\nb": 1, "a\nb": 2})", "rx.json");
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().message, R"(rx.json:a\nb: given twice, want it once)");
  JsonReader nested = Read(R"({"k": {"a\tb": "x"}})");
  nested.Object("k").Number("a\tb", 0, 1);
  EXPECT_EQ(FinishMessage(nested), R"(rx.json:k.a\tb: got "x", want 0..1)");
}

TEST(JsonReader, PrefersTheMisspeltKeyToTheMissingOne) {
  JsonReader json = Read(R"({"spere": -1})");
  json.Number("sphere", -30, 30);
  EXPECT_EQ(FinishMessage(json), "rx.json:spere: unknown key, want sphere");
}

TEST(JsonReader, FindsUnknownKeysInsideArrays) {
  JsonReader json = Read(R"({"list": [{"k": 1}, {"k": 2, "extra": 3}]})");
  for (JsonReader& item : json.Objects("list")) item.Number("k", 0, 9);
  EXPECT_EQ(FinishMessage(json), "rx.json:list[1].extra: unknown key, want k");
}

TEST(JsonReader, HasDoesNotCountAsReading) {
  JsonReader json = Read(R"({"axis": 90})");
  EXPECT_TRUE(json.Has("axis"));
  EXPECT_THAT(FinishMessage(json), HasSubstr("axis: unknown key"));
}

TEST(JsonReader, ReportsTheFirstErrorAndStaysHarmlessAfterIt) {
  JsonReader json = Read(R"({"a": 5, "b": "x"})");
  EXPECT_EQ(json.Number("a", 10, 20), 10);  // what is nearest to 0 in the range
  EXPECT_EQ(json.Number("b", -1, 1), 0);
  EXPECT_EQ(json.Object("c").Number("d", -3, -2), -2);
  EXPECT_TRUE(json.Objects("e").empty());
  EXPECT_EQ(FinishMessage(json), "rx.json:a: got 5, want 10..20");
}

TEST(JsonReader, CarriesChecksOfTheCaller) {
  JsonReader json = Read(R"({"OS": {"axis": 10}})");
  JsonReader os = json.Object("OS");
  os.Number("axis", 0, 180);
  os.Fail("axis", "got an axis without a cylinder, want both or neither");
  EXPECT_EQ(FinishMessage(json),
            "rx.json:OS.axis: got an axis without a cylinder, want both or neither");
  EXPECT_FALSE(os.Finish().has_value());
}

TEST(JsonReader, RefusesKeysGivenTwice) {
  EXPECT_EQ(ParseMessage(R"({"OD": {"sphere": 1, "sphere": 2}})"),
            "rx.json:OD.sphere: given twice, want it once");
  EXPECT_EQ(ParseMessage(R"({"a": {"k": 1}, "b": {"k": 1}})"), "");
}

TEST(JsonReader, RefusesWhatIsNotAnObject) {
  EXPECT_EQ(ParseMessage("[1, 2]"), "rx.json: got an array of 2, want an object");
  EXPECT_EQ(ParseMessage("3"), "rx.json: got 3, want an object");
}

TEST(JsonReader, RefusesNaNInfinityAndOverflow) {
  EXPECT_THAT(ParseMessage(R"({"a": NaN})"), StartsWith("rx.json: not JSON: line 1, column 7"));
  EXPECT_THAT(ParseMessage(R"({"a": -Infinity})"), StartsWith("rx.json: not JSON: line 1"));
  EXPECT_EQ(ParseMessage(R"({"a": 1e999})"), "rx.json: not JSON: number overflow parsing '1e999'");
}

TEST(JsonReader, SaysWhereBrokenTextBreaks) {
  EXPECT_THAT(ParseMessage("{\"a\": 1,\n \"b\" 2}"), StartsWith("rx.json: not JSON: line 2"));
  EXPECT_THAT(ParseMessage(""), StartsWith("rx.json: not JSON: line 1"));
  EXPECT_THAT(ParseMessage("{} {}"), StartsWith("rx.json: not JSON: line 1"));
  EXPECT_THAT(ParseMessage("{\"a\": \"\xff\"}"), StartsWith("rx.json: not JSON: line 1"));
}

TEST(JsonReader, RefusesAbsurdNesting) {
  const std::string deep = "{\"a\": " + std::string(40, '[') + std::string(40, ']') + "}";
  EXPECT_THAT(ParseMessage(deep), HasSubstr("nested deeper than 32 levels"));
}

TEST(JsonReader, CutsLongTextInErrors) {
  JsonReader json = Read("{\"a\": \"" + std::string(500, 'x') + "\"}");
  json.Number("a", 0, 1);
  EXPECT_LT(FinishMessage(json).size(), 100u);
}

TEST(JsonReader, TellsObjectsFromOtherValues) {
  const JsonReader json = Read(R"({"o": {}, "n": 1, "a": [], "z": null})");
  EXPECT_TRUE(json.IsObject("o"));
  for (const char* key : {"n", "a", "z", "absent"}) EXPECT_FALSE(json.IsObject(key)) << key;
}

TEST(JsonReader, ListsItsKeys) {
  EXPECT_THAT(Read(R"({"b": 1, "a": 2})").Keys(), testing::UnorderedElementsAre("a", "b"));
}

TEST(JsonReader, ChildrenOutliveTheirParent) {
  JsonReader od = Read(R"({"OD": {"sphere": 2}})").Object("OD");
  EXPECT_EQ(od.Number("sphere", -30, 30), 2);
  EXPECT_EQ(FinishMessage(od), "");
}

}  // namespace
}  // namespace lorgnette
