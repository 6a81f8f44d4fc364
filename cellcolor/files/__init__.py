"""How every file is read and written: strictly, whole or not at all, never over something else."""
