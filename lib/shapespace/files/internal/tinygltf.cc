// The glTF library's implementation, in a file of its own because it takes long to compile.
#define TINYGLTF_IMPLEMENTATION
#include <shapespace/files/internal/tinygltf.h>
