#include <shapespace/files/pose_order.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

namespace shapespace {
namespace {

/// The name of a file, apart from its numbers, and these.
struct NumberedName {
  std::string text;
  /// Without zeros in front: of two, that with more digits is larger.
  std::vector<std::pair<size_t, std::string>> numbers;

  explicit NumberedName(std::string_view name) {
    constexpr std::string_view kDigits = "0123456789";
    while (!name.empty()) {
      const size_t letters = std::min(name.find_first_of(kDigits), name.size());
      text.append(name, 0, letters);
      name.remove_prefix(letters);
      const size_t digits = std::min(name.find_first_not_of(kDigits), name.size());
      if (digits == 0) continue;
      const size_t zeros = std::min(name.find_first_not_of('0'), digits);
      numbers.emplace_back(digits - zeros, name.substr(zeros, digits - zeros));
      text += '0';
      name.remove_prefix(digits);
    }
  }
};

/// Of files [first, last), whose names differ in numbers only, one that is followed by a smaller
/// number; `last` if the order is as it should be.
size_t Misplaced(const std::vector<std::string>& files, const std::vector<NumberedName>& names,
                 size_t first, size_t last) {
  const auto in = [&](const auto& all) { return all.begin() + static_cast<std::ptrdiff_t>(first); };
  const auto smaller = [](const NumberedName& a, const NumberedName& b) {
    return a.numbers < b.numbers;
  };
  const auto larger = [](const NumberedName& a, const NumberedName& b) {
    return a.numbers > b.numbers;
  };
  const auto end = names.begin() + static_cast<std::ptrdiff_t>(last);
  const auto misplaced = std::adjacent_find(in(names), end, larger);
  if (misplaced == end) return last;
  const bool descends = std::is_sorted(in(names), end, larger);
  const bool is_shells =
      std::is_sorted(in(files), files.begin() + static_cast<std::ptrdiff_t>(last));
  const bool repeats =
      std::set<NumberedName, decltype(smaller)>(in(names), end, smaller).size() < last - first;
  if (repeats || (descends && !is_shells)) return last;
  return static_cast<size_t>(misplaced - names.begin());
}

}  // namespace

std::string OrderWarning(const std::vector<std::string>& files) {
  const std::vector<NumberedName> names(files.begin(), files.end());
  for (size_t first = 0, last = 0; first < files.size(); first = last) {
    while (last < files.size() && names[last].text == names[first].text) ++last;
    const size_t i = Misplaced(files, names, first, last);
    if (i == last) continue;
    return "the numbers in the names of the poses do not ascend: " + files[i] + " is in front of " +
           files[i + 1] +
           ", and the poses are used in this order. If it is not meant, write the numbers with "
           "zeros in front, as 02 and 10, or name the files one by one";
  }
  return {};
}

}  // namespace shapespace
