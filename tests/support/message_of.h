#ifndef SHAPESPACE_TESTS_SUPPORT_MESSAGE_OF_H_
#define SHAPESPACE_TESTS_SUPPORT_MESSAGE_OF_H_

#include <functional>
#include <string>

namespace shapespace::testing {

/// The message of the error that `call` throws; errors of other types are not caught.
template <class ErrorType>
std::string MessageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const ErrorType& error) {
    return error.what();
  }
  return "nothing was thrown";
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_MESSAGE_OF_H_
