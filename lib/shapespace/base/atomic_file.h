#ifndef SHAPESPACE_BASE_ATOMIC_FILE_H_
#define SHAPESPACE_BASE_ATOMIC_FILE_H_

#include <functional>
#include <ostream>
#include <string>

namespace shapespace {

/// Writes a file so that nobody ever sees half of it: `body` fills a temporary beside `file`, which
/// is then renamed onto it. Folders on the way are made. If anything fails, the temporary is
/// removed and what stood at `file` before stands there still. \throw FileError if the folder, the
/// temporary or the rename fails, or the stream went bad.
void WriteFileAtomically(const std::string& file, const std::function<void(std::ostream&)>& body);

/// Removes the temporaries of all files that any thread is writing. From then on no file is begun
/// or finished: `WriteFileAtomically` waits forever. For a process that is about to end, and may
/// not wait until its files are written. Takes a lock, so signal handlers must not call it.
void AbandonUnfinishedFiles();

}  // namespace shapespace

#endif  // SHAPESPACE_BASE_ATOMIC_FILE_H_
