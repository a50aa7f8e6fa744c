;; What `drive_emacs.el' asks for, with eglot.
(require 'eglot)
(setq eglot-sync-connect 60
      eglot-connect-timeout 120
      jsonrpc-default-request-timeout 60)

(defun drive-join ()
  "Have the server serve this buffer: what a command would do when it has ended, of which there are none."
  (run-hooks 'post-command-hook)
  (flymake-start))

(defun drive-told ()
  "Return what is underlined, and the first line of what is said of it."
  (mapcar (lambda (one)
            (vector (buffer-substring-no-properties (flymake-diagnostic-beg one) (flymake-diagnostic-end one))
                    (replace-regexp-in-string "^mlmg \\[.*?\\]: " ""
                                              (car (split-string (flymake-diagnostic-text one) "\n")))))
          (flymake-diagnostics)))

(defun drive-completions () (eglot-completion-at-point))
(defun drive-fix () (let ((last-nonmenu-event t)) (call-interactively #'eglot-code-actions)))
(defun drive-format () (eglot-format-buffer))

(defun drive-rename (name)
  "Give it another NAME, and say that files which are not open may be changed too."
  (cl-letf (((symbol-function 'y-or-n-p) (lambda (_) t)))
    (eglot-rename name)))

(defun drive-hover ()
  "Return what the echo area shows of what is under the cursor."
  (let (said)
    (eglot-hover-eldoc-function (lambda (text &rest _) (setq said text)))
    (drive-await "what is said of it" (lambda () said))))
