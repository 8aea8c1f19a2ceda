// The programs in Python that come with alphadot.
#pragma once

#include <string>
#include <vector>

namespace alphadot {

/// The file of a script of this name, such as "mesh.py": in share/alphadot beside the folder of the installed
/// program, or in the sources that it was built from. Throws InputError when it is in neither.
std::string companion_script(const std::string& name);

/// Becomes the script: replaces this process by Debian's Python running it with the arguments after argv[1].
/// Returns only when that fails, with the exit code; what is wrong has then been printed.
int become_companion(const std::string& name, int argc, char** argv);

/// Runs the script with arguments as a process of its own and gives the last line that it prints; its errors
/// go where this program's do. Throws InputError when it cannot be started or fails.
std::string output_of_companion(const std::string& name, const std::vector<std::string>& arguments);

}  // namespace alphadot
