#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace fathom {

/// Name of this machine in its network; "unknown" where it has none.
std::string host_name();

/// Number of this process, and what it is one among: a boot of a machine, and a container of it.
/// Within one such space a number belongs to one process at a time.
long process_number();
std::string process_space();

/// Whether no process of this space has a number.
bool is_dead_process(long number);

/// Marks what this process makes in a folder that others use, too: a word for names of files.
std::string process_mark();

/// Whether a mark is that of a process of this space which is dead. Of processes elsewhere, and of
/// those before the last boot, that cannot be known.
bool is_mark_of_dead(std::string_view mark);

/// Number of the user whose process this is.
unsigned user_number();

/// A word that no other call on any machine returns.
std::string unique_word();

/// Processor time of this process so far, of all its threads and of the processes that it has
/// waited for, in seconds.
double processor_seconds();

/// The most memory that this process, or one that it has waited for, has had, in MiB.
double peak_memory_mib();

/// Has the heap keep what is freed for what comes next, up to 256 MiB of the main thread's and 64
/// MiB of each other's, in blocks of 32 MiB at most: else pictures and matrices of a few megabytes
/// go back to the system each time, and come again page by page.
void keep_free_memory();

/// Gives memory that the heap holds and nobody uses back to the system, where the system's heap
/// can.
void return_free_memory();

/// Returns once the content of a file, or the entries of a folder, are on their disk. Throws
/// EnvironmentError.
void sync_to_disk(const std::filesystem::path& file);

}  // namespace fathom
