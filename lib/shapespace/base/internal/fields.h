#ifndef SHAPESPACE_BASE_INTERNAL_FIELDS_H_
#define SHAPESPACE_BASE_INTERNAL_FIELDS_H_

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

// The fields of structs, each listed once for all who show or set them. A list is an overload of a
// function, found by argument-dependent lookup:
//
//   template <typename Visit> void ForFields(Of<Summary>, const Visit& visit);
// calls visit(name, get) for each field of a summary. JSON reports and Python's attributes are made
// of it.
//
//   template <typename Visit> void ForOptions(Of<Options>, const Visit& visit);
// calls visit(name, get, about) for each field of a struct of options; `about` says in a sentence
// what it is. Python's keywords and the command line's flags are made of it.
//
// std::invoke(get, object) is the field's value, and for options a reference to it.

namespace shapespace::internal {

/// Stands for a type in the choice of an overload.
template <typename T>
struct Of {};

/// The values of an enumeration with the words for them in reports and files, in Python and on the
/// command line: `Words<Enum> WordsOf(Of<Enum>)`.
template <typename Enum>
using Words = std::vector<std::pair<const char*, Enum>>;

template <typename Enum>
const char* WordOf(Enum value) {
  for (const auto& [word, known] : WordsOf(Of<Enum>())) {
    if (known == value) return word;
  }
  return "unknown";
}

/// What `text` stands for; none if it is no word of the enumeration.
template <typename Enum>
std::optional<Enum> FromWord(const std::string& text) {
  for (const auto& [word, value] : WordsOf(Of<Enum>())) {
    if (word == text) return value;
  }
  return {};
}

/// All words of an enumeration, separated by commas, each in `quotes`.
template <typename Enum>
std::string ListWords(const std::string& quotes = "") {
  std::string list;
  for (const auto& [word, value] : WordsOf(Of<Enum>())) {
    list += (list.empty() ? "" : ", ") + quotes + word + quotes;
  }
  return list;
}

/// Visits the options of a part of a struct as options of the whole.
template <typename Part, typename Whole, typename Visit>
void ForOptionsOfPart(Part Whole::*part, const Visit& visit) {
  ForOptions(Of<Part>(), [&](const char* name, auto field, const char* about) {
    const auto of_whole = [ part, field ](auto& whole) -> auto& {
      return std::invoke(field, whole.*part);
    };
    visit(name, of_whole, about);
  });
}

struct IgnoreField {
  template <typename Get>
  void operator()(const char*, const Get&) const {}
};

/// Whether there is a list of the fields of a summary.
template <typename T, typename = void>
struct HasFields : std::false_type {};
template <typename T>
struct HasFields<T, std::void_t<decltype(ForFields(Of<T>(), IgnoreField()))>> : std::true_type {};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_FIELDS_H_
