//! The command line: adapters, standard input and output, exit codes.
