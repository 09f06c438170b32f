#ifndef SHAPESPACE_BASE_INTERNAL_FIELDS_H_
#define SHAPESPACE_BASE_INTERNAL_FIELDS_H_

#include <type_traits>

namespace shapespace::internal {

/// Stands for a struct in the choice of an overload of
///   template <typename Visit> void ForFields(Of<Struct>, const Visit& visit);
/// which calls visit(name, get) for each field of a summary; std::invoke(get, summary) is its
/// value. This list is the only one: JSON reports and Python's attributes are made of it.
template <typename T>
struct Of {};

struct IgnoreField {
  template <typename Get>
  void operator()(const char*, const Get&) const {}
};

/// Whether there is such a list.
template <typename T, typename = void>
struct HasFields : std::false_type {};
template <typename T>
struct HasFields<T, std::void_t<decltype(ForFields(Of<T>(), IgnoreField()))>> : std::true_type {};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_FIELDS_H_
