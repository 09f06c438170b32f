# Writes PAGE, the manual page of the program TOOL, from its --help-all: cmake -DTOOL= -DPAGE= -DHELP2MAN= -P
execute_process(COMMAND ${TOOL} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
# The first line is "name: summary".
string(REGEX MATCH "^[^\n:]*: ([^\n]*)" line "${help}")
execute_process(COMMAND ${HELP2MAN} --no-info --help-option=--help-all --name=${CMAKE_MATCH_1} --output=${PAGE} ${TOOL}
                COMMAND_ERROR_IS_FATAL ANY)
