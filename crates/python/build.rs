//! Shows the linker of macOS that Python itself brings what this library calls, as the linkers of other systems take for granted.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
