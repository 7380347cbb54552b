// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/input/value.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <functional>

#include "common/errors.hpp"

namespace fastjoint::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string message(const std::string& text, const std::function<void(const Value&)>& read) {
  try {
    read(Value(parse("f.json", text)));
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}
const auto nothing = [](const Value&) {};

TEST(Json, SyntaxErrorsNameLineAndColumn) {
  EXPECT_THAT(message("{\n  \"a\": 1,\n  \"b\" 2\n}", nothing),
              AllOf(StartsWith("f.json: not valid JSON at line 3, column 7"), HasSubstr("a colon is missing")));
  EXPECT_THAT(message("", nothing), StartsWith("f.json: not valid JSON at line 1, column 1"));
  EXPECT_THAT(message("{\"a\": 1} x", nothing), StartsWith("f.json: not valid JSON at line 1, column 10"));
  EXPECT_THAT(message("{\"a\": nan}", nothing), StartsWith("f.json: not valid JSON at line 1"));
  EXPECT_THAT(message("{\"a\": 1e999}", nothing), StartsWith("f.json: not valid JSON"));
  EXPECT_THAT(message(std::string("{\"a\": \"\xff\"}"), nothing), StartsWith("f.json: not valid JSON"));
}

/// What to do, in words of those who write JSON by hand.
TEST(Json, SaysWhatToDoAboutCommonMistakes) {
  const auto says = [](const std::string& text, const std::string& sentence) {
    EXPECT_THAT(message(text, nothing), AllOf(StartsWith("f.json: "), HasSubstr(sentence))) << text;
    EXPECT_THAT(message(text, nothing), testing::Not(HasSubstr("literal"))) << text;
    EXPECT_THAT(message(text, nothing), testing::Not(HasSubstr("exception"))) << text;
  };
  says("", "the file is empty");
  says(" \n\t\r\n", "the file is empty");
  says("{\"a\": 1}}", "column 9: something follows the last closing bracket; remove it, or see which bracket closes");
  says("{\"a\" 1}", "column 6: a colon is missing between a key and its value");
  says("{\"a\": \"b\n\"}", "a text goes over the end of its line; close its double quotes");
  says("{\"a\": 1.}", "this number is incomplete; write 1 or 1.0, 0.5, 1e-3");
  says("{\"a\": 1,\n}", "line 2, column 1: there is one comma too many before '}'; remove it");
  says("{\"a\": [1, 2,]}", "column 13: a value is missing before ']', or there is one comma too many");
  says("{\"a\": [1,,2]}", "column 10: there is one comma too many, or a value is missing before it");
  says("{\"a\": }", "a value is missing before '}'");
  says("{\"E\": 72,4}", "a number follows a comma where a key must; write decimals with a point, 72.5");
  says("{\"a\": 1 \"b\": 2}", "a comma is missing before this");
  says("{\"a\": [1 2]}", "a comma is missing before this");
  says("{\"a\": [1, 2", "the text ends too early; a closing bracket or quote is missing");
  says("{'a': 1}", "a text or key in double quotes");
  says("{\"a\": NaN}", "allowed: a number, a text or key in double quotes, true, false");
  says("{\"a\": .5}", "allowed: a number");
  says("{\"a\": \"\xe4\"}", "a character is not UTF-8; save the file as UTF-8");
  EXPECT_THAT(message("{\"a\": 1e150}", [](const Value& v) { (void)v.at("a").number(); }),
              HasSubstr("/a: 1e+150 is not allowed; allowed: 0, or a size from 1e-100 to 1e+100, in other units"));
  EXPECT_THAT(message("{\"a\": 6e-309}", [](const Value& v) { (void)v.at("a").number(positive); }),
              HasSubstr("/a: 6e-309 is not allowed; allowed: a number from 1e-100 to 1e+100, in other units"));
  says("{\"a\": 1e999}", "'1e999' is too large; allowed: numbers up to 1.8e308");
  const std::string sixteen("{\0\"\0a\0", 7);
  says("\xff\xfe" + sixteen, "is encoded in UTF-16; save it as UTF-8");
  says(sixteen, "is encoded in UTF-16; save it as UTF-8");
  says(std::string("{\"a\": 1}\n\0{\"b\"", 14), "a byte of value 0 at line 2, column 1; allowed: text");
  EXPECT_EQ(message("\xef\xbb\xbf{\"a\": 1}", nothing), "no error") << "the mark of UTF-8";
}

TEST(Json, RefusesCharactersThatEndStringsOrLinesElsewhere) {
  const char* what = "holds a control character, such as the end of a line; allowed: any other character";
  for (const char* character : {R"(\u0000)", R"(\n)", R"(\u001b)", R"(\u007f)"}) {
    EXPECT_THAT(message(fmt::format(R"({{"a": "x{}y"}})", character), nothing),
                AllOf(HasSubstr("the string \"x"), HasSubstr(what)));
    EXPECT_THAT(message(fmt::format(R"({{"x{}": 1}})", character), nothing), HasSubstr(what));
  }
  EXPECT_EQ(message(R"({"a": "\u00e4 \u0020"})", nothing), "no error");
}

TEST(Json, DuplicateKeysAreRefusedAtEveryDepth) {
  EXPECT_THAT(message(R"({"a": 1, "a": 2})", nothing), HasSubstr("key \"a\" stands twice"));
  EXPECT_THAT(message(R"({"a": [{"b": 1, "c": {"d": 1}, "b": 2}]})", nothing), HasSubstr("key \"b\" stands twice"));
  EXPECT_EQ(message(R"({"a": {"b": 1}, "c": {"b": 1}})", nothing), "no error");
}

/// Arrays as deep as a text is long would overflow the stack of what shows or copies them.
TEST(Json, DepthHasALimit) {
  const auto nested = [](int n, const std::string& open, const std::string& close) {
    std::string text;
    for (int i = 0; i < 2 * n; ++i) text += i < n ? open : close;
    return text;
  };
  const auto number = [](const Value& v) { (void)v.number(); };
  EXPECT_THAT(message(nested(100, "[", "]"), number), HasSubstr("is not allowed; allowed: a number"));
  EXPECT_THAT(message(nested(101, "[", "]"), number),
              StartsWith("f.json: /: arrays and objects are nested more than 100"));
  EXPECT_THAT(message("{\"b\": 1, \"a\": " + nested(100000, "[", "]") + "}", number),
              AllOf(StartsWith("f.json: /a: "), HasSubstr("allowed: at most 100")));
  EXPECT_THAT(message(nested(100000, "{\"a\":", "}"), number), StartsWith("f.json: /a: "));
}

TEST(Json, CommentsAreAllowed) { EXPECT_EQ(message("{ // why\n \"a\": /* what */ 1}", nothing), "no error"); }

TEST(Value, NamesPlaceFoundAndAllowed) {
  const auto third = [](const Value& v) { (void)v.at("a").items()[2].at("E").number(positive); };
  EXPECT_EQ(message(R"({"a": [0, 1, {"E": -1}]})", third), "f.json: /a/2/E: -1 is not allowed; allowed: a number > 0");
  EXPECT_EQ(message(R"({"a": [0, 1, {"E": "x"}]})", third),
            "f.json: /a/2/E: \"x\" is not allowed; allowed: a number > 0");
  EXPECT_EQ(message(R"({"a": [0, 1, {}]})", third),
            "f.json: /a/2: key \"E\" is missing; allowed: an object with \"E\"");
}

TEST(Value, UnknownKeysAreRefused) {
  const auto only = [](const Value& v) { v.only({"a", "b"}); };
  EXPECT_EQ(message(R"({"a": 1, "c~/": 2})", only), "f.json: /c~0~1: unknown key; allowed: a, b");
  EXPECT_THAT(message("[1]", only), HasSubstr("allowed: an object"));
}

TEST(Value, RangesAreOpenOrClosed) {
  const Range range{.low = -1, .high = 0.5, .low_allowed = false};
  const auto read = [&](const Value& v) { (void)v.number(range); };
  EXPECT_EQ(message("0.5", read), "no error");
  EXPECT_THAT(message("-1", read), HasSubstr("a number > -1 and <= 0.5"));
  EXPECT_THAT(message("0.6", read), HasSubstr("0.6 is not allowed"));
  EXPECT_THAT(message("true", read), HasSubstr("true is not allowed"));
}

TEST(Value, IntegersMayBeWrittenAsDecimals) {
  const auto read = [](const Value& v) { (void)v.integer(1, 8); };
  EXPECT_EQ(message("8.0", read), "no error");
  EXPECT_THAT(message("8.5", read), HasSubstr("an integer from 1 to 8"));
  EXPECT_THAT(message("1e300", read), HasSubstr("an integer from 1 to 8"));
}

TEST(Value, OtherKinds) {
  EXPECT_THAT(message("[1,2,3]", [](const Value& v) { (void)v.items(2, 2); }),
              HasSubstr("array of 3; allowed: exactly 2"));
  EXPECT_THAT(message("[]", [](const Value& v) { (void)v.items(1); }), HasSubstr("at least 1"));
  EXPECT_THAT(message("[]", [](const Value& v) { (void)v.items(1, 4); }), HasSubstr("1 to 4"));
  EXPECT_THAT(message("\"\"", [](const Value& v) { (void)v.text(); }), HasSubstr("not empty"));
  EXPECT_THAT(message("1", [](const Value& v) { (void)v.boolean(); }), HasSubstr("true or false"));
  EXPECT_THAT(message("\"z\"", [](const Value& v) { (void)v.choice({"x", "y"}); }), HasSubstr(R"("x", "y")"));
  EXPECT_THAT(message("\"z\"", [](const Value& v) { (void)v.choice({}); }), HasSubstr("allowed: nothing, since"));
  EXPECT_THAT(message(R"({"": 1})", [](const Value& v) { (void)v.members(); }), HasSubstr("a key is empty"));
}

TEST(Value, ChecksFormatAndVersion) {
  const auto read = [](const Value& v) { check_format(v, "plate"); };
  EXPECT_EQ(message(R"({"format": "plate", "version": 1, "$schema": "x"})", read), "no error");
  EXPECT_THAT(message(R"({"format": "joint", "version": 1})", read), StartsWith("f.json: /format:"));
  EXPECT_THAT(message(R"({"format": "plate", "version": 2})", read), StartsWith("f.json: /version:"));
}

}  // namespace
}  // namespace fastjoint::input
