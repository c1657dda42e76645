"""Set-up, benchmarks, packages, the demo, pictures, and a window to test in."""
