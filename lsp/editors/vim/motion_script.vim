" Vim 8 and newer with ALE: in .vimrc, behind what loads plugins.
augroup motion_script
  autocmd!
  autocmd BufRead,BufNewFile *.ms set filetype=motion-script
  autocmd FileType motion-script setlocal commentstring=#\ %s iskeyword+=- omnifunc=MotionScriptComplete
augroup END

" For Ctrl-X Ctrl-O: ALE by itself takes ASCII letters alone for parts of a name, and knows of no names in quotes.
function! MotionScriptComplete(findstart, base) abort
  if !a:findstart
    return ale#completion#OmniFunc(0, a:base)
  endif
  let l:before = strpart(getline('.'), 0, col('.') - 1)
  let l:start = match(l:before, count(l:before, '"') % 2 ? '"[^"]*$' : '\k*$')
  call ale#completion#GetCompletions('ale-omnifunc', {'prefix': strpart(l:before, l:start)})
  return l:start
endfunction

" For :ALEFix: ALE asks no server to format.
function! MotionScriptFormat(buffer) abort
  return {'command': 'mlmg fmt -'}
endfunction
let g:ale_fixers = extend(get(g:, 'ale_fixers', {}), {'motion-script': [function('MotionScriptFormat')]})

function! MotionScriptRoot(buffer) abort
  let l:found = ale#path#FindNearestFile(a:buffer, 'mlmg.toml')
  return fnamemodify(empty(l:found) ? bufname(a:buffer) : l:found, ':p:h')
endfunction

call ale#linter#Define('motion-script', {
\   'name': 'mlmg',
\   'lsp': 'stdio',
\   'executable': 'mlmg',
\   'command': '%e lsp --stdio --position-encoding utf-8',
\   'language': 'motion-script',
\   'project_root': function('MotionScriptRoot'),
\})
let g:ale_completion_enabled = 1
