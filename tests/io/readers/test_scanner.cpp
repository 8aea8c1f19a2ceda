// Scanner: numbers and words in every encoding, and the errors for what is none.
#include "io/scanner.hpp"

#include "io/readers/small_meshes.hpp"

namespace alphadot {
namespace {

using test::error_of;
using test::expect_parts;

TEST(Scanner, ReadsNumbersOfText) {
  Scanner in("  12 -7\r\n+3.5\t1e-300 9000000000", "mesh");
  EXPECT_EQ(in.read_int("i"), 12);
  EXPECT_EQ(in.read_int("i"), -7);
  EXPECT_EQ(in.read_real("x"), 3.5);
  EXPECT_EQ(in.read_real("x"), 1e-300);
  EXPECT_EQ(in.read_long("n"), 9'000'000'000);
  EXPECT_TRUE(in.at_end());
}

TEST(Scanner, ReadsNumbersOfEitherByteOrder) {
  for (const Encoding encoding : {Encoding::little_endian, Encoding::big_endian}) {
    const std::string content = test::Writer(encoding).ints({-2}).longs({1LL << 40}).reals({0.1}).content();
    Scanner in(content, "mesh");
    in.set_encoding(encoding);
    EXPECT_EQ(in.read_int("i"), -2);
    EXPECT_EQ(in.read_long("n"), 1LL << 40);
    EXPECT_EQ(in.read_real("x"), 0.1);
    EXPECT_EQ(in.remaining(), 0u);
  }
  EXPECT_EQ(test::Writer(Encoding::big_endian).ints({1}).content(), std::string("\0\0\0\1", 4));
}

TEST(Scanner, NamesFileLineAndWordOfWhatIsNoNumber) {
  const auto read = [](auto member, const std::string& text) {
    return error_of([&] { (Scanner("\n\n" + text, "mesh").*member)("a tag"); });
  };
  expect_parts(read(&Scanner::read_int, "abc"), {"mesh:3: ", "a tag", "'abc'"});
  expect_parts(read(&Scanner::read_int, "12x"), {"'12x'"});
  expect_parts(read(&Scanner::read_int, "1.5"), {"'1.5'"});
  expect_parts(read(&Scanner::read_int, "+-1"), {"'+-1'"});
  expect_parts(read(&Scanner::read_int, "3000000000"), {"out of range"});
  expect_parts(read(&Scanner::read_long, "99999999999999999999"), {"out of range"});
  expect_parts(read(&Scanner::read_real, "1e999"), {"out of range"});
  expect_parts(read(&Scanner::read_real, "nan"), {"not a finite number"});
  expect_parts(read(&Scanner::read_real, "-inf"), {"not a finite number"});
  expect_parts(read(&Scanner::read_real, "0x1"), {"'0x1'"});
  expect_parts(read(&Scanner::read_real, std::string(100, 'z')), {"'zzzz", "...'"});
  expect_parts(read(&Scanner::read_real, "\x01z"), {"'?z'"});
  expect_parts(read(&Scanner::read_real, "  "), {"the file ends where a tag should stand"});
}

TEST(Scanner, NamesTheByteOfWhatIsWrongInBinary) {
  const std::string content =
      test::Writer(native_encoding).ints({1}).reals({std::numeric_limits<double>::quiet_NaN()}).content();
  Scanner in(content, "mesh");
  in.set_encoding(native_encoding);
  in.read_int("i");
  expect_parts(error_of([&] { in.read_real("x of a point"); }),
               {"mesh: x of a point", "not a finite", "byte 4"});
  expect_parts(error_of([&] { in.read_int("a tag"); }), {"the file ends where a tag", "byte 12"});
}

TEST(Scanner, RefusesCountsThatTheFileCannotHold) {
  const RecordShape shape{.longs = 1, .reals = 3};
  // Text: eight characters a record, the last of which may end the file.
  EXPECT_EQ(Scanner("2 1 0 0 0 2 0 0 0", "mesh").read_int_count("n", shape), 2);
  expect_parts(error_of([&] { Scanner("3 1 0 0 0 2 0 0 0", "mesh").read_int_count("n", shape); }),
               {"n is 3", "16 bytes"});
  expect_parts(error_of([&] { Scanner("-1", "mesh").read_long_count("n", shape); }), {"negative"});
  expect_parts(error_of([&] { Scanner("9223372036854775807 1", "mesh").read_long_count("n", shape); }),
               {"more than"});

  const std::string content =
      test::Writer(native_encoding).longs({2}).reals({1, 2, 3, 4, 5, 6, 7, 8}).content();
  Scanner in(content, "mesh");
  in.set_encoding(native_encoding);
  EXPECT_EQ(in.read_long_count("n", shape), 2);
  EXPECT_EQ(in.capacity(shape), 2);
  expect_parts(error_of([&] { in.check_count(3, "n", shape); }), {"n is 3"});
}

TEST(Scanner, PassesOverComments) {
  Scanner in("% first\nKEY= value % why\n1 2 % three\n%4\n5%", "mesh", '%');
  EXPECT_EQ(in.read_word('='), "KEY");
  EXPECT_TRUE(in.accept('='));
  EXPECT_FALSE(in.accept('='));
  EXPECT_FALSE(in.at_end_of_line());
  EXPECT_EQ(in.read_word(), "value");
  EXPECT_TRUE(in.at_end_of_line());
  EXPECT_EQ(in.read_int("i"), 1);
  EXPECT_EQ(in.read_int("i"), 2);
  EXPECT_TRUE(in.at_end_of_line());
  EXPECT_EQ(in.read_int("i"), 5);
  EXPECT_TRUE(in.at_end());
}

TEST(Scanner, ReadsLinesOfEitherEnding) {
  Scanner in("one\r\ntwo\n\nend", "mesh");
  EXPECT_EQ(in.peek_line(), "one");
  EXPECT_EQ(in.read_line(), "one");
  EXPECT_EQ(in.read_line(), "two");
  EXPECT_EQ(in.read_line(), "");
  EXPECT_EQ(in.read_line(), "end");
  EXPECT_EQ(in.read_line(), "");
  EXPECT_TRUE(in.at_end());
}

TEST(Scanner, FindsAndExpectsText) {
  Scanner in("abc $End tail", "mesh");
  EXPECT_FALSE(in.skip_past("$Begin"));
  EXPECT_TRUE(in.skip_past("$End"));
  expect_parts(error_of([&] { in.expect("head"); }), {"mesh:1: head should stand here, not 'tail'"});
  expect_parts(error_of([&] { in.expect("head"); }), {"the file ends where head should stand"});
}

}  // namespace
}  // namespace alphadot
