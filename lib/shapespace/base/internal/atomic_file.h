#ifndef SHAPESPACE_BASE_INTERNAL_ATOMIC_FILE_H_
#define SHAPESPACE_BASE_INTERNAL_ATOMIC_FILE_H_

#include <functional>
#include <ostream>
#include <string>

namespace shapespace::internal {

/// Writes a file atomically: `body` fills a new file beside `file`, whose name cannot be foreseen
/// and which is then renamed to it, so that an incomplete file is never visible. A `file` that is a
/// link is replaced, not followed. Missing folders are created. On failure the temporary is removed
/// and an existing `file` remains unchanged. \throw FileError if the folder, the temporary or the
/// rename fails, or the stream has an error.
void WriteFileAtomically(const std::string& file, const std::function<void(std::ostream&)>& body);

/// Removes the temporaries of all files that any thread is writing, and blocks all further calls of
/// `WriteFileAtomically` forever. For a process that is about to end and cannot wait for its files.
/// Takes a lock, so signal handlers must not call it.
void AbandonUnfinishedFiles();

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_ATOMIC_FILE_H_
