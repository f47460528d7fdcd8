# The CMake package of the installed project.
