#ifndef SHAPESPACE_BASE_INTERNAL_TEXT_H_
#define SHAPESPACE_BASE_INTERNAL_TEXT_H_

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/number_chars.h>
#include <shapespace/base/internal/quoted.h>

// Strict reading of lines, words and numbers of a text file.

namespace shapespace::internal {

/// The remedy for a damaged file; ends most messages.
inline constexpr char kReexport[] = "; is the file damaged? Export the mesh again";

/// The remedy where a vertex has the number 0 in a text that counts from 1.
inline constexpr char kCountsFromOne[] =
    "; the first vertex has the number 1: if the file counts from 0, add 1 to all of its numbers";

/// Throws a FileError "file:line: what"; without the line if it is 0.
[[noreturn]] inline void FailAt(const std::string& file, int line, const std::string& what) {
  throw FileError(file + (line > 0 ? ":" + std::to_string(line) : "") + ": " + what);
}

/// Replaces the byte order mark with which some editors begin a text in UTF-8 by blanks.
inline void BlankByteOrderMark(std::string* text) {
  if (text->compare(0, 3, "\xEF\xBB\xBF") == 0) text->replace(0, 3, 3, ' ');
}

/// The text without that mark.
inline std::string_view WithoutByteOrderMark(std::string_view text) {
  return text.substr(text.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0);
}

/// The text with a to z in place of A to Z.
inline std::string InSmallLetters(std::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return small;
}

/// Iterates over the lines of a text, terminated by LF, CR LF or CR, and counts them from 1.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  /// Returns false at the end of the text.
  bool Next(std::string_view* line) {
    if (position_ >= text_.size()) return false;
    const size_t end = std::min(text_.find_first_of("\r\n", position_), text_.size());
    *line = text_.substr(position_, end - position_);
    const bool two = text_.substr(end, 2) == "\r\n";
    position_ = end + (two ? 2 : 1);
    ++number_;
    return true;
  }

  int Number() const { return number_; }

  /// Bytes of the text after the current line.
  size_t BytesLeft() const { return text_.size() - std::min(position_, text_.size()); }

 private:
  std::string_view text_;
  size_t position_ = 0;
  int number_ = 0;
};

/// Iterates over the words of a line, separated by blanks and tabs.
class LineWords {
 public:
  explicit LineWords(std::string_view line) : rest_(line) { SkipBlanks(); }

  bool Done() const { return rest_.empty(); }

  /// The next word; empty at the end of the line.
  std::string_view Next() {
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t"));
    rest_.remove_prefix(word.size());
    SkipBlanks();
    return word;
  }

  /// The rest of the line, without trailing blanks.
  std::string_view Rest() const { return rest_.substr(0, rest_.find_last_not_of(" \t") + 1); }

 private:
  void SkipBlanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size())); }

  std::string_view rest_;
};

/// Whether a text begins with 1.#QNAN, 1.#IND, 1.#INF or the like: what programs made by
/// Microsoft's compilers before 2015 write in place of a number, shortened as the number would have
/// been.
inline bool BeginsWithNotANumber(std::string_view text) {
  return text.size() > 3 && text.substr(0, 3) == "1.#" && text[3] >= 'A' && text[3] <= 'Z';
}

/// The line in front of a comment. The # of 1.#QNAN begins none.
inline std::string_view WithoutComment(std::string_view line) {
  size_t at = line.find('#');
  while (at != std::string_view::npos && at >= 2 && BeginsWithNotANumber(line.substr(at - 2))) {
    at = line.find('#', at + 1);
  }
  return line.substr(0, at);
}

inline std::string_view WithoutPlus(std::string_view word) {
  const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+';
  return plus ? word.substr(1) : word;
}

/// The whole word as a number, which may be infinite or NaN; empty if it is not a number.
inline std::optional<double> ParseDouble(std::string_view word) {
  word = WithoutPlus(word);
  if (BeginsWithNotANumber(word.substr(word.substr(0, 1) == "-"))) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double value = 0.0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = FromChars(word.data(), end, &value);
  if (stop != end || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // from_chars does not distinguish overflow from underflow: underflow is recognised by a
    // negative exponent or, without exponent, by a leading zero (0.000...).
    const size_t exponent = word.find_first_of("eE");
    const bool tiny = exponent == std::string_view::npos ? word[word[0] == '-'] == '0'
                                                         : word[exponent + 1] == '-';
    return tiny ? 0.0 : std::numeric_limits<double>::infinity();
  }
  return value;
}

/// The whole word as an integer; empty if it is not one.
inline std::optional<std::int64_t> ParseInteger(std::string_view word) {
  word = WithoutPlus(word);
  std::int64_t value = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (stop != end || error != std::errc()) return std::nullopt;
  return value;
}

/// Whether the word is a number whose decimal point is a comma.
inline bool HasDecimalComma(std::string_view word) {
  const size_t comma = word.find(',');
  if (comma == std::string_view::npos || comma + 1 == word.size()) return false;
  std::string with_point(word);
  with_point[comma] = '.';
  return ParseDouble(with_point).has_value();
}

/// "'word' is not a number", and the remedy.
inline std::string NotANumber(std::string_view word) {
  constexpr char kComma[] =
      ", since it has a decimal comma; write the file again with decimal points";
  return Quoted(word) + " is not a number" + (HasDecimalComma(word) ? kComma : kReexport);
}

/// An element of a file, such as its third vertex; converted to text only for messages.
struct ElementName {
  const char* kind;
  size_t number = 0;  ///< counted from 1; 0 for none

  std::string Text() const {
    return number > 0 ? std::string(kind) + " " + std::to_string(number) : kind;
  }
};

/// The whole word as a finite number.
/// \throw FileError "file:line: element: what 'word' is not ..." otherwise.
inline double FiniteNumber(std::string_view word, const char* what, const std::string& file,
                           int line, const ElementName& element) {
  if (word.empty()) FailAt(file, line, element.Text() + ": " + what + " is missing" + kReexport);
  const std::optional<double> value = ParseDouble(word);
  if (!value) {
    FailAt(file, line, element.Text() + ": " + what + " " + NotANumber(word));
  }
  if (!std::isfinite(*value)) {
    FailAt(
        file, line,
        element.Text() + ": " + what + " " + Quoted(word) + " is not a finite number" + kReexport);
  }
  return *value;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_TEXT_H_
