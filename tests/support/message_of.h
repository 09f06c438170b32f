#ifndef SHAPESPACE_TESTS_SUPPORT_MESSAGE_OF_H_
#define SHAPESPACE_TESTS_SUPPORT_MESSAGE_OF_H_

#include <cctype>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace shapespace::testing {

constexpr char kNothingThrown[] = "nothing was thrown";

/// The message of the error that `call` throws; errors of other types are not caught.
template <class ErrorType>
std::string MessageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const ErrorType& error) {
    return error.what();
  }
  return kNothingThrown;
}

/// Whether `part` is in `message`, not as a part of a longer word or number.
inline bool HasWord(const std::string& message, const std::string& part) {
  const auto joins = [](char a, char b) {
    return std::isalnum(static_cast<unsigned char>(a)) &&
           std::isalnum(static_cast<unsigned char>(b));
  };
  for (size_t at = message.find(part); at != std::string::npos; at = message.find(part, at + 1)) {
    const size_t end = at + part.size();
    if ((at == 0 || part.empty() || !joins(message[at - 1], part.front())) &&
        (end == message.size() || part.empty() || !joins(part.back(), message[end]))) {
      return true;
    }
  }
  return false;
}

/// Whether the message of an error names all `parts`: the file and line, the element, the option,
/// the numbers.
inline ::testing::AssertionResult Names(const std::string& message,
                                        const std::vector<std::string>& parts) {
  if (message == kNothingThrown) return ::testing::AssertionFailure() << message;
  for (const std::string& part : parts) {
    if (!HasWord(message, part)) {
      return ::testing::AssertionFailure() << "no '" << part << "' in: " << message;
    }
  }
  return ::testing::AssertionSuccess();
}

/// The same of as many messages, such as warnings, as there are lists of parts.
inline ::testing::AssertionResult EachNames(const std::vector<std::string>& messages,
                                            const std::vector<std::vector<std::string>>& parts) {
  if (messages.size() != parts.size()) {
    return ::testing::AssertionFailure() << ::testing::PrintToString(messages);
  }
  for (size_t i = 0; i < parts.size(); ++i) {
    const ::testing::AssertionResult named = Names(messages[i], parts[i]);
    if (!named) return named;
  }
  return ::testing::AssertionSuccess();
}

/// The same of a call, which must throw an `ErrorType`.
template <class ErrorType>
::testing::AssertionResult Refuses(const std::function<void()>& call,
                                   const std::vector<std::string>& parts) {
  return Names(MessageOf<ErrorType>(call), parts);
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_MESSAGE_OF_H_
